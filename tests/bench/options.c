#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tests/bench/options.h"

void bench_fail(const char *what, const char *why)
{
    fprintf(stderr, "bench: %s: %s\n", what, why);
    exit(1);
}

static void read_word(bench_options *o, const char *word)
{
    char name[16];
    int at = 0;
    if (sscanf(word, "%15[a-z]=%n", name, &at) != 1 || !at)
        bench_fail(word, "name=value expected");
    const char *value = word + at;
    bool on = strcmp(value, "1") == 0;
    if (strcmp(name, "scene") == 0)
        o->scene = value;
    else if (strcmp(name, "isa") == 0)
        o->isa = value;
    else if (strcmp(name, "out") == 0)
        o->out = value;
    else if (strcmp(name, "with") == 0)
        o->with = value;
    else if (strcmp(name, "change") == 0)
        o->change = value;
    else if (strcmp(name, "pattern") == 0)
        o->pattern = value;
    else if (strcmp(name, "derivative") == 0)
        o->derivative = value;
    else if (strcmp(name, "threads") == 0)
        o->threads = atoi(value);
    else if (strcmp(name, "samples") == 0)
        o->samples = atoi(value);
    else if (strcmp(name, "indirect") == 0)
        o->indirect = atoi(value);
    else if (strcmp(name, "times") == 0)
        o->times = atoi(value);
    else if (strcmp(name, "lamps") == 0)
        o->lamps = atoi(value);
    else if (strcmp(name, "float") == 0)
        o->is_float = on;
    else if (strcmp(name, "reuse") == 0)
        o->no_reuse = !on;
    else if (strcmp(name, "shadows") == 0)
        o->shadows = on;
    else if (strcmp(name, "lens") == 0)
        o->lens = on;
    else if (strcmp(name, "area") == 0)
        o->area = on;
    else if (strcmp(name, "adaptive") == 0)
        o->adaptive = on;
    else
        bench_fail(word, "no such option");
}

bench_options bench_options_read(int argc, char **argv)
{
    bench_options o = { .scene = "workshop", .change = "none", .pattern = "none", .derivative = "none", .threads = 1, .samples = 1,
                        .lamps = 1, .shadows = true };
    if (argc < 2)
        bench_fail(argv[0], "a mode expected");
    o.mode = argv[1];
    for (int i = 2; i < argc; i++)
        read_word(&o, argv[i]);
    if (o.threads < 1 || o.threads > 64 || o.samples < 1 || o.samples > 64)
        bench_fail("threads, samples", "1 .. 64 expected");
    if (o.indirect < 0 || o.indirect > 1024)
        bench_fail("indirect", "0 .. 1024 expected");
    if (o.lamps < 1 || o.lamps > 1024)
        bench_fail("lamps", "1 .. 1024 expected");
    return o;
}

static double clock_ms(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

double bench_now_ms(void) { return clock_ms(CLOCK_MONOTONIC); }

double bench_processor_ms(void) { return clock_ms(CLOCK_PROCESS_CPUTIME_ID); }

void bench_say(const char *name, const char *unit, double value) { printf("%s %s %.6g\n", name, unit, value); }

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double bench_median_of(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, by_value);
    return values[count / 2];
}

enum { COUNT_MAX = 31, WARM_MS = 100, MEASURE_MS = 300 };

/// Calls `measure` repeatedly and stores the results in `values`. Returns the number of calls.
static int run(double (*measure)(void *state), void *state, double values[COUNT_MAX], double processor[COUNT_MAX])
{
    int count = 0;
    for (double start = bench_now_ms(); bench_now_ms() - start < WARM_MS;)
        measure(state);
    for (double start = bench_now_ms(); !count || (count < COUNT_MAX && bench_now_ms() - start < MEASURE_MS); count++) {
        const double before = bench_processor_ms();
        values[count] = measure(state);
        processor[count] = bench_processor_ms() - before;
    }
    return count;
}

double bench_median(double (*measure)(void *state), void *state)
{
    double values[COUNT_MAX], processor[COUNT_MAX];
    return bench_median_of(values, run(measure, state, values, processor));
}

void bench_say_render(double (*measure)(void *state), void *state)
{
    double values[COUNT_MAX], processor[COUNT_MAX];
    const int count = run(measure, state, values, processor);
    bench_say("render", "ms", bench_median_of(values, count));
    bench_say("cpu", "ms", bench_median_of(processor, count));
}
