/// The options of one run of a side, from words like `frame scene=1k threads=2 shadows=0`, and the output of its results.
#ifndef GLINT_BENCH_OPTIONS_H
#define GLINT_BENCH_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct bench_options {
    const char *mode; ///< "frame", "job", ...: the first word
    const char *scene; ///< of scenes.h; default "workshop"
    const char *isa; ///< only glint; NULL: the best
    const char *out; ///< a file or folder to write to
    const char *with; ///< a file to compare with
    const char *change; ///< of a job: "light", "sphere", "shininess", "number" (of the pattern) or "none" (default)
    const char *pattern; ///< "checker", "octaves" or "marble" of the first material, or "phong": a shader instead of the model
        ///< of all; for POV-Ray "checker" and "marble", or "checker-function" and "marble-function". "none" (default)
    const char *derivative; ///< a pass by it: "eye", "lamp" or "shininess"; only glint. "none" (default)
    int threads; ///< default 1
    int samples; ///< a pixel; default 1
    int indirect; ///< ways of indirect light a pixel, of one bounce; default 0
    int times; ///< of a shutter that is open from one frame of a job to the next; glint's `reuse` alone; 0 (default): none
    int lamps; ///< point lights that share the light, default 1; above 1 for glint and POV-Ray alone
    bool is_float; ///< glint alone
    bool no_reuse; ///< glint alone
    bool shadows; ///< default true
    bool lens; ///< the scene's lens is open; for glint and POV-Ray alone
    bool area; ///< 16 samples of a sphere light instead of a point light
    bool adaptive; ///< all samples only where neighbours differ by more than a tenth; only for glint and POV-Ray, of 16
} bench_options;

/// Ends the program with a message when a word is not understood.
bench_options bench_options_read(int argc, char **argv);

double bench_now_ms(void);
/// The processor's time of this program so far, all threads.
double bench_processor_ms(void);

/// Prints one measurement as the driver reads it: name, unit, value.
void bench_say(const char *name, const char *unit, double value);

/// Calls `measure`, whose result is in milliseconds, for a tenth of a second to warm up (at least once), and then up to
/// 31 times, until three tenths of a second have gone by.
/// Returns the median.
double bench_median(double (*measure)(void *state), void *state);

/// The same, printed as "render", and as "cpu" the median of the processor's times of the calls.
void bench_say_render(double (*measure)(void *state), void *state);

/// Median of `values`, which are sorted.
double bench_median_of(double *values, int count);

/// Ends the program.
_Noreturn void bench_fail(const char *what, const char *why);

#endif
