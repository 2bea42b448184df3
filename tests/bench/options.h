/// The options of one run of a side, from words like `frame scene=1k threads=2 shadows=0`, and the printing of its
/// results.
#ifndef GLINT_BENCH_OPTIONS_H
#define GLINT_BENCH_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct bench_options {
    const char *mode; ///< "frame", "job", ...: the first word
    const char *scene; ///< from scenes.h; default "workshop"
    const char *isa; ///< for glint; NULL: the best
    const char *out; ///< a file or folder to write to
    const char *with; ///< a file to compare with
    const char *change; ///< of a job: "light", "sphere", "shininess", "number" (in the pattern) or "none" (default)
    const char *pattern; ///< "checker", "octaves" or "marble" for the first material, or "phong": a shader for all
        ///< materials; for POV-Ray "checker" and "marble", or "checker-function" and "marble-function". "none"
        ///< (default)
    const char *derivative; ///< a derivative pass: "eye", "lamp" or "shininess"; only glint. "none" (default)
    int threads; ///< default 1
    int samples; ///< per pixel; default 1
    int indirect; ///< paths of indirect light per pixel, with one bounce; default 0
    int times; ///< of a shutter open from one frame of a job to the next; only glint's `reuse`; 0 (default): none
    int lamps; ///< point lights that share the light, default 1; above 1 only for glint and POV-Ray
    bool is_float; ///< only glint
    bool no_reuse; ///< only glint
    bool shadows; ///< default true
    bool lens; ///< the scene's lens is open; only glint and POV-Ray
    bool area; ///< 16 samples of a sphere light instead of a point light
    bool adaptive; ///< all 16 samples only where neighbours differ by more than a tenth; only glint and POV-Ray
} bench_options;

/// Ends the program with a message for an unknown word.
bench_options bench_options_read(int argc, char **argv);

double bench_now_ms(void);
/// The processor time of this program so far, over all threads.
double bench_processor_ms(void);

/// Prints one measurement in the driver's format: name, unit, value.
void bench_say(const char *name, const char *unit, double value);

/// Calls `measure`, which returns milliseconds, for a tenth of a second to warm up (at least once), then up to 31
/// times within three tenths of a second. Returns the median.
double bench_median(double (*measure)(void *state), void *state);

/// The same, printed as "render", and the median processor time of the calls as "cpu".
void bench_say_render(double (*measure)(void *state), void *state);

/// Median of the sorted `values`.
double bench_median_of(double *values, int count);

/// Ends the program.
_Noreturn void bench_fail(const char *what, const char *why);

#endif
