/// Helpers that use the engine only through its public headers, and the counting of checks that every program here uses.
#ifndef HARD_DRIVE_H
#define HARD_DRIVE_H

#include "engine/glint.h"
#include "engine/glint_inspect.h"
#include "tests/hard/oracle/oracle.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

// ---- Counting ----

/// Reads the arguments: --table prints Markdown tables, --rays N sets the number of fuzz rays, --seed N their seed.
/// Any other argument ends the program. HARD_RAYS in the environment also sets the number of rays.
void hard_begin(int argc, char **argv);
extern bool hard_table;
extern uint64_t hard_rays; ///< number of fuzz rays; default 1e6

/// Begins a test: all checks up to the next one belong to it. id: as in the list of hard cases.
void hard_test(const char *id, const char *what);
/// Checks one condition and prints the message when it fails (the first ten failures of a program). Returns `ok`;
/// combine several with `&`, so that each is evaluated.
__attribute__((format(printf, 2, 3))) int hard_check(bool ok, const char *format, ...);
/// Counts correct results that are too many to check one by one.
void hard_right(uint64_t checks);
/// Records a case about a feature that the engine does not have.
void hard_absent(const char *id, const char *what);
/// Prints the totals. Returns the exit code for main.
int hard_end(void);

/// In tables, prints the heading, and a line for each test as it ends, for programs whose tests have no values to show.
void hard_list_tests(const char *title);
/// In tables, prints the heading of lines of values.
void hard_columns(const char *title);
/// An empty cell among the values of a line.
#define HARD_BLANK (-HUGE_VAL)
typedef struct hard_values {
    double truth, in_double, in_float; ///< the oracle's value; the engine's values in double and float
    double naive_double, naive_float; ///< the values of the textbook's formula in double and float
} hard_values;
void hard_row(const char *id, const char *what, const hard_values *values, bool right);

// ---- Random numbers ----

uint64_t random_bits(void);
void random_seed(uint64_t seed);
double uniform(double low, double high);
double log_uniform(double low, double high);
bool chance(double share);
void random_direction(double v[3]); ///< the length is 1 up to the last bits

// ---- Objects ----

/// Ends the program with the engine's message when the call has failed.
void must(glint_status status, const glint_error *error);

glint_scene *scene_new(void);
void scene_light_up(glint_scene *scene, double ambient, const double background[3]);
void scene_camera(glint_scene *scene, const glint_camera_desc *desc);
/// Adds an object to the scene, which holds the only reference to it.
glint_shape *scene_sphere(glint_scene *scene, const hard_sphere *sphere, glint_material *material);
glint_shape *scene_plane(glint_scene *scene, const hard_plane *plane, glint_material *material);
void scene_light(glint_scene *scene, const glint_light_desc *desc);

glint_material *material_new(glint_model model, const double diffuse[3], double specular, double shininess);

/// Creates an empty file with a unique name. The caller removes it. `ending` includes the dot.
void temporary_file(char path[64], const char *ending);

/// Casts one ray.
bool cast(const glint_scene *scene, const hard_ray *ray, glint_hit *hit);

typedef struct frame_desc {
    int width, height;
    glint_precision precision;
    uint32_t passes; ///< mask of the bits 1u << GLINT_PASS_...
    int threads; ///< number of threads; 0: one thread
    const char *isa; ///< instruction set; NULL: the one that the environment names, otherwise the best one
} frame_desc;

/// Returns whether this machine and build can render with an instruction set.
bool isa_usable(const char *isa);

/// Renders a frame. `stats` may be NULL.
glint_image *frame(const glint_scene *scene, const frame_desc *desc, glint_frame_stats *stats);
glint_image *frame_to_depth(const glint_scene *scene, const frame_desc *desc, double max_depth,
                            glint_frame_stats *stats);
/// Renders one pixel along the ray, with a camera that looks there.
glint_image *frame_of_ray(glint_scene *scene, const hard_ray *ray, glint_precision precision, uint32_t passes);
void pixel(const glint_image *image, glint_pass pass, int x, int y, float out[3]);
/// Counts the pixels of a pass that differ in any bit, except the sign of 0.
long pixels_that_differ(const glint_image *a, const glint_image *b, glint_pass pass);

#endif
