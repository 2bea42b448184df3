/// The options of one run of a side, from words like `frame scene=1k threads=2 shadows=0`,
/// and the printing of its results.
#ifndef GLINT_BENCH_OPTIONS_H
#define GLINT_BENCH_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct bench_options {
    const char *mode; ///< what to measure, the first word: "frame", "job", ...
    const char *scene; ///< name of a scene in scenes.h; default "workshop"
    const char *isa; ///< instruction set, only for glint; NULL: the best one
    const char *out; ///< a file or folder to write to
    const char *with; ///< a file to compare with
    const char *change; ///< the change between frames of a job: "light", "sphere", "shininess", "number" (in the
        ///< pattern) or "none" (default)
    const char *pattern; ///< "checker", "octaves" or "marble" for the first material, or "phong", a shader for all
        ///< materials; for POV-Ray "checker" and "marble",
        ///< or "checker-function" and "marble-function"; default "none"
    const char *derivative; ///< parameter of a derivative pass, only for glint: "eye", "lamp", "shininess" or "none"
        ///< (default)
    int threads; ///< number of threads; default 1
    int samples; ///< samples per pixel; default 1
    int indirect; ///< paths of indirect light per pixel, with one bounce; default 0
    int times; ///< times of a shutter that is open from one frame of a job to the next, only for glint's `reuse`; 0
        ///< (default): none
    int lamps; ///< number of point lights that share the light, default 1; above 1 only for glint and POV-Ray
    bool is_float; ///< single precision; only for glint
    bool no_reuse; ///< reuse switched off; only for glint
    bool shadows; ///< whether the light casts shadows; default true
    bool lens; ///< whether the scene's lens is open; only for glint and POV-Ray
    bool area; ///< whether 16 samples of a sphere light replace the point light
    bool adaptive; ///< whether pixels take all 16 samples only where neighbours differ by more than a tenth; only for
        ///< glint and POV-Ray
} bench_options;

/// Ends the program with a message for an unknown word.
bench_options bench_options_read(int argc, char **argv);

double bench_now_ms(void);
/// Returns the processor time of this program so far, summed over all threads, in milliseconds.
double bench_processor_ms(void);

/// Prints one measurement in the driver's format: name, unit, value.
void bench_say(const char *name, const char *unit, double value);

/// Calls `measure`, which returns milliseconds, for a tenth of a second to warm up (at least once), then up to 31
/// times within three tenths of a second. Returns the median.
double bench_median(double (*measure)(void *state), void *state);

/// Like bench_median, but prints the median as "render", and the median processor time of the calls as "cpu".
void bench_say_render(double (*measure)(void *state), void *state);

/// Returns the median of the sorted `values`.
double bench_median_of(double *values, int count);

/// Ends the program.
_Noreturn void bench_fail(const char *what, const char *why);

#endif
