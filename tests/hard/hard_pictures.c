/// Whole pictures against 113-bit arithmetic: nine still lifes with different ranges of numbers. In double no pixel
/// may show a wrong object, a wrong shadow or a colour off by more than one 8-bit step. In float this holds for
/// scenes whose numbers span four digits, and for nearly all pixels of random ones. The errors of float and of the
/// textbook's formulas are printed.
#include "tests/hard/oracle/still.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define WIDTH 96
#define HEIGHT 72
#define TIMED_SCALE 8 ///< factor by which the sides of the timed pictures are larger
#define TIMED_RUNS 15 ///< timed runs for each precision

/// Makes three spheres that touch a huge sphere and cast shadows on each other.
static hard_still ordinary(const char *name, double ground)
{
    hard_still s = { .name = name,
                     .count = 4,
                     .spheres = { { { -1.5, 1, 0 }, 1 },
                                  { { 1, 0.75, 1.25 }, 0.75 },
                                  { { 0.5, 1.5, -2 }, 1.5 },
                                  { { 0, -ground, 0 }, ground } },
                     .paint = { { { 0.75, 0.25, 0.25 }, 0.5, 50 },
                                { { 0.25, 0.5, 0.75 }, 0.375, 10 },
                                { { 0.5, 0.75, 0.25 }, 0.25, 200 },
                                { { 0.5, 0.5, 0.5 }, 0, 1 } },
                     .light = { 5, 8, 6 },
                     .eye = { 0.25, 2.5, 9 },
                     .at = { 0, 1, 0 },
                     .fov_y_rad = 0.75,
                     .ambient = 0.125,
                     .background = { 0.125, 0.1875, 0.25 } };
    return s;
}

static hard_still telephoto(void)
{
    hard_still s = ordinary("telephoto: r=1 at 1e4", 100);
    const double eye[3] = { 277, 2500, 9680 };
    memcpy(s.eye, eye, sizeof eye);
    s.fov_y_rad = 6.5e-4;
    return s;
}

static void move(double v[3], double scale, const double by[3])
{
    for (int c = 0; c < 3; c++)
        v[c] = v[c] * scale + by[c];
}

static hard_still moved(const char *name, double scale, const double by[3])
{
    hard_still s = ordinary(name, 100);
    for (int i = 0; i < s.count; i++) {
        move(s.spheres[i].c, scale, by);
        s.spheres[i].r *= scale;
    }
    move(s.light, scale, by);
    move(s.eye, scale, by);
    move(s.at, scale, by);
    return s;
}

typedef struct errors {
    long object, shadow, over1, wrong; ///< numbers of pixels with a wrong object, a wrong shadow or a colour off by
        ///< more than one step; with any of these
    int worst; ///< largest colour error, in 8-bit steps
    double ms; ///< shortest time for the larger picture; 0: not measured
} errors;

static int code(double linear)
{
    const double x = linear < 0 ? 0 : linear > 1 ? 1 : linear;
    return (int)floor(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055) + 0.5);
}

static void note(errors *sum, const still_pixel *want, const still_pixel *got)
{
    int off = 0;
    for (int c = 0; c < 3; c++) {
        const int d = isfinite(got->color[c]) ? abs(code(got->color[c]) - code(want->color[c])) : 255;
        off = d > off ? d : off;
    }
    sum->object += got->object != want->object;
    sum->shadow += got->object == want->object && got->lit != want->lit;
    sum->over1 += off > 1;
    sum->wrong += got->object != want->object || got->lit != want->lit || off > 1;
    sum->worst = off > sum->worst ? off : sum->worst;
}

/// Measures the processor time of both precisions in turn, several times. Stores the shortest time, which other
/// programs affect least.
static void time_both(const hard_still *still, errors *in_float, errors *in_double)
{
    glint_scene *scene = still_scene(still);
    in_float->ms = in_double->ms = HUGE_VAL;
    for (int i = 0; i < 2 * TIMED_RUNS; i++) {
        errors *one = i % 2 ? in_float : in_double;
        const frame_desc desc = { WIDTH * TIMED_SCALE,
                                  HEIGHT * TIMED_SCALE,
                                  i % 2 ? GLINT_PRECISION_FLOAT : GLINT_PRECISION_DOUBLE,
                                  1u << GLINT_PASS_BEAUTY,
                                  1,
                                  NULL };
        const clock_t start = clock();
        glint_image_release(frame(scene, &desc, NULL));
        one->ms = fmin(one->ms, 1e3 * (double)(clock() - start) / CLOCKS_PER_SEC);
    }
    glint_scene_release(scene);
}

static errors engine_errors(const hard_still *still, const still_pixel *want, glint_precision precision)
{
    errors sum = { 0 };
    glint_scene *scene = still_scene(still);
    const frame_desc desc = {
        WIDTH, HEIGHT, precision, 1u << GLINT_PASS_BEAUTY | 1u << GLINT_PASS_DIFFUSE | 1u << GLINT_PASS_OBJECT_ID,
        1,     NULL
    };
    glint_frame_stats stats;
    glint_image *image = frame(scene, &desc, &stats);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const still_pixel got = still_engine_pixel(image, x, y);
            note(&sum, &want[y * WIDTH + x], &got);
        }
    hard_check(stats.nonfinite == 0, "%ld pixels are not finite", (long)stats.nonfinite);
    glint_image_release(image);
    glint_scene_release(scene);
    return sum;
}

typedef still_pixel tracer(const hard_still *still, int width, int height, int x, int y);

static errors textbook_errors(const hard_still *still, const still_pixel *want, tracer *trace)
{
    errors sum = { 0 };
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const still_pixel got = trace(still, WIDTH, HEIGHT, x, y);
            note(&sum, &want[y * WIDTH + x], &got);
        }
    return sum;
}

/// Writes the cells that are identical on every machine. If README.md has this row, the row's cells must match.
static void write_row(char row[256], const char *name, const errors *in_float, const errors *in_double)
{
    snprintf(row, 256, "| %s | %ld, %ld, %ld | %ld, %ld, %ld |", name, in_float->object, in_float->shadow,
             in_float->over1, in_double->object, in_double->shadow, in_double->over1);
}

static double share_over1(const errors *e) { return 100.0 * (double)e->over1 / (WIDTH * HEIGHT); }

static void check_readme(const char *name, const char *row)
{
    char line[1024], start[128];
    snprintf(start, sizeof start, "| %s |", name);
    FILE *readme = fopen("README.md", "r");
    if (!readme)
        return;
    while (fgets(line, sizeof line, readme))
        if (!strncmp(line, start, strlen(start)))
            hard_check(!strncmp(line, row, strlen(row)), "README.md says %swhere it is %s", line, row);
    fclose(readme);
}

/// Checks that the true picture shows every object, both lit and in shadow.
static void check_truth(const hard_still *still, const still_pixel *want)
{
    long seen[STILL_MAX + 1] = { 0 }, shadows = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        seen[want[i].object]++;
        shadows += want[i].object == still->count && !want[i].lit;
    }
    for (int i = 1; i <= still->count; i++)
        hard_check(seen[i] > 100, "object %d covers %ld pixels", i, seen[i]);
    hard_check(shadows > 100, "%ld pixels of the ground in shadow", shadows);
}

static const still_pixel *trace_truth(const hard_still *still)
{
    static still_pixel want[WIDTH * HEIGHT];
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            want[y * WIDTH + x] = still_trace_113(still, WIDTH, HEIGHT, x, y);
    return want;
}

// ---- The bound of --precision float ----

/// Returns the range of a scene's numbers: the largest length or coordinate, in radii of the smallest sphere.
static double span_of(const hard_still *still)
{
    double least = HUGE_VAL, most = 0;
    for (int c = 0; c < 3; c++)
        most = fmax(most, fmax(fabs(still->eye[c]), fabs(still->light[c])));
    for (int i = 0; i < still->count; i++) {
        least = fmin(least, still->spheres[i].r);
        most = fmax(most, still->spheres[i].r);
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs(still->spheres[i].c[c]));
    }
    return most / least;
}

#define FLOAT_SPAN 2e4 ///< up to this span, float is as accurate as double except for one pixel in FLOAT_PIXELS
#define FLOAT_PIXELS 5000

/// Tests many still lifes within that range, of any size, near the origin and far from it.
static void check_float(int stills)
{
    hard_test("float", "still lifes of four digits");
    long wrong = 0, pixels = 0;
    for (int i = 0; i < stills; i++) {
        hard_still still;
        do
            still = still_random(log_uniform(1e-3, 1e3), log_uniform(1, 1e3));
        while (span_of(&still) > FLOAT_SPAN || span_of(&still) < 0.1 * FLOAT_SPAN);
        const errors e = engine_errors(&still, trace_truth(&still), GLINT_PRECISION_FLOAT);
        wrong += e.wrong;
        pixels += WIDTH * HEIGHT;
    }
    hard_check(wrong * FLOAT_PIXELS <= pixels, "in float, %ld of %ld pixels are wrong", wrong, pixels);
    if (hard_table)
        printf("\n`--precision float` in %d random still lifes whose numbers span 2e3 .. 2e4: %ld of %ld pixels with a "
               "wrong object,\na wrong shadow or a colour more than a code off.\n",
               stills, wrong, pixels);
}

static void compare(const hard_still *still)
{
    hard_test("picture", still->name);
    const still_pixel *want = trace_truth(still);
    check_truth(still, want);
    const errors textbook_float = textbook_errors(still, want, still_trace_24);
    const errors textbook_double = textbook_errors(still, want, still_trace_53);
    errors in_float = engine_errors(still, want, GLINT_PRECISION_FLOAT), in_double = engine_errors(still, want, GLINT_PRECISION_DOUBLE);
    hard_check(in_double.object == 0, "%ld pixels show a wrong object", in_double.object);
    hard_check(in_double.shadow == 0, "%ld pixels with a wrong shadow", in_double.shadow);
    hard_check(in_double.over1 == 0, "%ld pixels more than a code off, at most %d", in_double.over1, in_double.worst);
    hard_check(span_of(still) > FLOAT_SPAN || in_float.wrong == 0, "in float, %ld pixels are wrong", in_float.wrong);
    char row[256];
    write_row(row, still->name, &in_float, &in_double);
    check_readme(still->name, row);
    if (!hard_table)
        return;
    time_both(still, &in_float, &in_double);
    printf("%s %.1f, %.1f | %.1f %% | %.1f %% |\n", row, in_float.ms, in_double.ms, share_over1(&textbook_float),
           share_over1(&textbook_double));
}

int main(int argc, char **argv)
{
    hard_begin(argc, argv);
    const double away[3] = { 1e7, 0, 1e7 }, here[3] = { 0 };
    const hard_still stills[] = { ordinary("ordinary: 3 spheres, ground R=100", 100),
                                  ordinary("ground R=1e4", 1e4),
                                  ordinary("ground R=1e5", 1e5),
                                  ordinary("ground R=1e6", 1e6),
                                  ordinary("ground R=1e7", 1e7),
                                  telephoto(),
                                  moved("whole scene at offset 1e7", 1, away),
                                  moved("scale 1e-6", 1e-6, here),
                                  moved("scale 1e6", 1e6, here) };
    if (hard_table)
        printf("Pictures of %d x %d pixels against 113-bit arithmetic: pixels with a wrong object, with a wrong "
               "shadow, more "
               "than one 8-bit code off. Time of the processor: %d x %d pixels, least of %d.\n\n"
               "| scene | `--precision float` | double | ms, float and double | textbook in float, off | in double, "
               "off |\n"
               "| --- | --- | --- | --- | --- | --- |\n",
               WIDTH, HEIGHT, WIDTH * TIMED_SCALE, HEIGHT * TIMED_SCALE, TIMED_RUNS);
    for (size_t i = 0; i < sizeof stills / sizeof *stills; i++)
        compare(&stills[i]);
    check_float(hard_rays > 10000000 ? 1000 : 20);
    return hard_end();
}
