/// glint cost SCRIPT: what each setting of a scene costs in time and how far its picture is from a converged one.
/// Private to bindings/.
///
///   cost.c          the command: its options, the phases of a study in order
///   cost/values.c   the values of a knob
///   cost/knobs.c    the table of knobs: a setting that trades accuracy for time is a row of it
///   cost/scene.c    a scene whose materials and lights a knob edits, and gets back as they were
///   cost/shapes.c   the same for meshes: shading, and spheres of other segments
///   cost/moments.c  the same at the times of an open shutter
///   cost/cases.c    the settings to be measured, and the rows of the table that show them
///   cost/measure.c  one setting in the engine: its plan, and its picture in time
///   cost/errors.c   how far it is from the truth: the reference, decisions pixel by pixel
///   cost/timing.c   runs in random order, quartiles, the time that is left
///   cost/front.c    who is on the Pareto front, which combinations are worth a look, what to advise
///   cost/present.c  the study as data; cost/lines.lua the table for people, and lines for programs
///   cost/report.c   the page and the pictures; cost/page.lua, page.html, plot.lua, plot.css what is in them
#ifndef GLINT_COST_H
#define GLINT_COST_H

#include "bindings/command/cli.h"
#include "bindings/run/carried.h"

#define COST_KNOBS_MAX 16
#define COST_VALUES_MAX 12
#define COST_RUNS_MAX 64
#define COST_RUNS_LEAST 3 ///< a quartile of fewer means nothing
#define COST_COMBINATIONS_MAX 8
#define COST_REFERENCE_PARTS 4 ///< pictures of other seeds that the reference is the mean of
#define COST_LABEL_SIZE 128

// ---- cost/scene.c ----

typedef struct cost_shaded {
    glint_shape *shape; ///< borrowed
    glint_shading shading; ///< before it was edited
} cost_shaded;

/// The scene with spheres of other segments.
typedef struct cost_copy {
    double segments; ///< 0: exact
    glint_scene *scene; ///< owned
} cost_copy;

/// The objects that a knob may edit, each once, with their descriptions as the script left them.
typedef struct cost_scene {
    glint_scene *scene; ///< the planned scene: the original or a copy
    glint_scene *original; ///< borrowed
    cost_copy copies[COST_VALUES_MAX];
    int copy_count;
    cost_shaded *shaded; ///< meshes whose shading is edited now
    size_t shaded_count;
    glint_scene_desc desc; ///< of the original, as the script left it
    glint_material **materials;
    glint_material_desc *material_descs;
    size_t material_count;
    glint_light **lights;
    glint_light_desc *light_descs;
    double (*corners)[3]; ///< of all polygon lights: the descriptions' vertices
    size_t light_count;
} cost_scene;

bool cost_scene_open(cost_scene *scene, glint_scene *engine_scene); ///< false: out of memory
void cost_scene_close(cost_scene *scene);
/// Puts everything back.
void cost_scene_restore(cost_scene *scene);
/// Sets material or light i to a description.
glint_status cost_scene_set_material(cost_scene *scene, size_t i, const glint_material_desc *desc, glint_error *error);
glint_status cost_scene_set_light(cost_scene *scene, size_t i, const glint_light_desc *desc, glint_error *error);
/// Sets what the scene itself is described by.
glint_status cost_scene_set(cost_scene *scene, const glint_scene_desc *desc, glint_error *error);
/// Without indirect light every surface matt white, and of the lights only number `light` (all of them when it is not one's) at strength 1:
/// so that exactly the points that this light reaches are lit. Shadows stay as they are set.
glint_status cost_scene_show_light(cost_scene *scene, size_t light, glint_error *error);

// ---- cost/shapes.c ----

typedef struct cost_meshes {
    size_t count, globe_count; ///< meshes, and of these the spheres made of triangles; instances are counted
    bool is_mixed; ///< in their shading
    glint_shading shading; ///< of one of them
    double segments; ///< of all spheres of triangles; 0: they differ
} cost_meshes;

cost_meshes cost_scene_meshes(const cost_scene *scene);
glint_status cost_scene_set_shading(cost_scene *scene, glint_shading shading, glint_error *error);
/// Every sphere of triangles has so many segments, or, with 0, is exact. Before shading is set.
glint_status cost_scene_set_segments(cost_scene *scene, double segments, glint_error *error);
void cost_scene_restore_meshes(cost_scene *scene);
void cost_scene_close_meshes(cost_scene *scene);

// ---- cost/moments.c ----

/// The scene at the times of shutters that look more and less often; of a frame seen in an instant, none.
typedef struct cost_moments cost_moments;

/// Has the run tell it of them: before the script runs. NULL: out of memory.
cost_moments *cost_moments_open(glintL_moments *out);
void cost_moments_close(cost_moments *moments); ///< NULL: nothing
/// Why there are none though the shutter is open; NULL: there are, or it is not.
const char *cost_moments_lack(const cost_moments *moments);
/// How often the shutters look whose moments there are, the camera's own first; returns how many.
int cost_moments_counts(const cost_moments *moments, double out[COST_VALUES_MAX]);
/// Sets the scene's objects to time k of `times`; times and k 0: to the frame's own instant.
glint_status cost_moments_enter(const cost_moments *moments, glint_scene *scene, int times, int k, glint_error *error);

// ---- cost/knobs.c ----

typedef struct cost_value {
    const char *text; ///< NULL: it is the number
    double number;
} cost_value;

/// The frame that a knob is applied to.
typedef struct cost_subject {
    const glint_plan *plan; ///< of the frame as the script has it
    const glintL_render *render;
    const cost_scene *scene;
    const cost_moments *moments;
    bool has_neighbour; ///< the script has another frame beside this one
    bool is_pfm; ///< the file has no codes
} cost_subject;

typedef struct cost_values {
    int count; ///< 0: the scene does not respond
    int own; ///< which is the script's own
    int base; ///< which the other knobs' rows are measured with; mostly the same
    int truth; ///< which the reference is made with, where `has_truth`; else the base
    bool has_truth;
    cost_value value[COST_VALUES_MAX];
} cost_values;

/// One setting before it is measured; knobs change it.
typedef struct cost_draft {
    cost_scene *scene;
    glintL_render render;
    int shutter_times; ///< 0: it is seen in an instant
    bool reuses; ///< measured after the neighbouring frame, keeping what that leaves
} cost_draft;

typedef enum cost_source {
    COST_ERROR_FILM, ///< the linear light, before it becomes codes
    COST_ERROR_FILE ///< what the codes of the file keep of it
} cost_source;

typedef struct cost_knob {
    const char *name; ///< as in the output
    const char *needs; ///< what a scene lacks that does not respond: "a light that casts shadows"
    cost_source source; ///< where its error comes from
    bool combines; ///< it trades accuracy for time: combinations with others are looked at
    bool is_other_time; ///< its times are of another thing than a whole frame: no point of the front
    /// Tells by the plan whether the scene responds, and lists the values.
    void (*list)(const cost_subject *subject, cost_values *out);
    glint_status (*apply)(cost_draft *draft, cost_value value, glint_error *error);
} cost_knob;

extern const cost_knob cost_knobs[];
extern const int cost_knob_count; ///< <= COST_KNOBS_MAX
int cost_knob_find(const char *name, size_t length); ///< -1: none
/// Whether a list "samples,model" names knobs only. False: the message is written.
bool cost_knobs_check(const char *list, char message[GLINTL_MESSAGE_SIZE]);

// ---- cost/values.c ----

/// The numbers in order, with the script's own among them.
void cost_list_numbers(const double *numbers, int count, double own, cost_values *out);
/// The words, of which the script's own is the `own`-th, from 0.
void cost_list_words(const char *const *words, int count, int own, cost_values *out);
/// Which of the words a value is; the last when it is none.
int cost_find_word(cost_value value, const char *const *words, int count);
void cost_value_text(cost_value value, char out[32]);

// ---- A study ----

typedef struct cost_quartiles {
    double min, q1, median, q3;
} cost_quartiles;

/// COST_TOTAL: wall time of rendering, tone and encoding. COST_CPU: processor time of all threads. Rows are compared by
/// COST_CPU, because a busy machine changes it little.
typedef enum cost_part { COST_RENDER, COST_TONE, COST_ENCODE, COST_TOTAL, COST_CPU, COST_PART_COUNT } cost_part;

/// A setting that is measured. Several rows may show one.
typedef struct cost_case {
    int choice[COST_KNOBS_MAX]; ///< the value of each knob; -1: as in the base
    int bits; ///< of its file, once it was run
    bool needs_file; ///< a row shows what the file keeps
    double estimate_ms; ///< of a run with its overhead
    int batch; ///< frames in a run, so that it takes long enough to be timed; 0: one
    double guess_ms, guess_cpu_ms; ///< of the frame without overhead, before the timed runs
    int run_count;
    double ms[COST_PART_COUNT][COST_RUNS_MAX];
    cost_quartiles time[COST_PART_COUNT]; ///< of the runs, by cost_summarize
    bool is_first_alone; ///< the only run is the first, which is dropped where there are more
    bool is_left_out; ///< of the timing, for want of budget
    glint_frame_stats stats; ///< of the last run
    glint_work work;
    bool is_counted; ///< work is known
    bool has_error;
    glint_picture_error film, file; ///< errors in linear light, and of the values in the file
    uint64_t wrong_object, wrong_shadow; ///< pixels
    uint8_t *picture, *difference; ///< PNG, owned, for the report; NULL without one
    size_t picture_size, difference_size;
} cost_case;

/// The visible object and the lights that reach it, at the sample in the middle of each pixel.
typedef struct cost_decisions {
    float *object; ///< owned; its number, 0: background
    uint8_t *lit; ///< owned; light_count planes: whether light i reaches the pixel
    size_t light_count; ///< 1 where there are too many to be looked at one by one
} cost_decisions;

typedef struct cost_row {
    int knob; ///< -1: a combination of several
    int value;
    int measured; ///< index of the case
    char label[COST_LABEL_SIZE]; ///< the value, or "samples=16 precision=float"
    bool is_default, is_front, is_resolved, is_partial;
    double x_fastest;
    int difference; ///< from the script's own time: -1 faster, 1 slower, 0 within the quartile range
    bool is_apart; ///< its quartile range overlaps with neither neighbour in the order of times
} cost_row;

typedef struct cost_study {
    cli_output *output;
    glintL_run *run;
    const cli_options *options;
    cost_scene scene;
    cost_moments *moments; ///< owned
    int shutter_times; ///< the script's own, where there are moments; 0: the frame is of an instant
    const glintL_render *own;
    cost_values values[COST_KNOBS_MAX]; ///< of each knob; count 0: not selected, or the scene does not respond
    glint_renderer *renderers[2][2]; ///< [keeps stages][counts work]; owned, except the one that belongs to the run
    cost_case *cases; ///< number 0 is the base
    int case_count;
    cost_row *rows;
    int row_count;
    int runs; ///< wanted of each case, the first not counted
    int most_runs; ///< of a case whose quartiles do not part from its neighbours'
    double run_ms; ///< what a run should take at least
    double overhead_ms; ///< of finding the error of a picture
    double start_ms, deadline_ms; ///< deadline 0: none
    uint64_t random;

    double reference_samples; ///< of each part; 0: there is none
    double reference_seed[COST_REFERENCE_PARTS];
    glint_reference *reference; ///< the mean of the parts
    glint_picture_error reference_error; ///< of that mean, by how far the parts are from it
    cost_decisions truth; ///< of the base, in double
    bool is_complete; ///< not interrupted
    char *live; ///< of --live, HTML for the page; owned; NULL: none

    char **left_out; ///< owned lines: what the budget or the scene left out
    int left_out_count;
    char advice[512];
} cost_study;

bool cost_leave_out(cost_study *study, const char *format, ...) __attribute__((format(printf, 2, 3)));
bool cost_is_stopped(const cost_study *study); ///< a signal came, or the run has failed

// ---- cost/cases.c ----

/// Fills values, cases and rows: each knob by itself around the base. False: the run has failed.
bool cost_list_cases(cost_study *study, const cost_subject *subject);
/// Adds a combination; false: no memory.
bool cost_add_combination(cost_study *study, const int choice[COST_KNOBS_MAX]);
const cost_knob *cost_row_knob(const cost_row *row); ///< NULL: a combination
const glint_picture_error *cost_row_error(const cost_study *study, const cost_row *row); ///< NULL: not measured
/// The knob's name and the value: "samples 16"; of a combination its label.
void cost_row_name(const cost_row *row, char out[COST_LABEL_SIZE]);

// ---- cost/measure.c ----

/// How a case is to be planned, where that is not its own way.
typedef struct cost_shot {
    uint32_t passes;
    bool codes;
    double samples; ///< 0: the case's
    double seed; ///< < 0: the case's
    bool is_exact; ///< decided in double
    bool is_painted; ///< matt white under light number `light`
    size_t light;
} cost_shot;

double cost_cpu_ms(void); ///< time on processors so far, of all threads of the process
bool cost_fail(cost_study *study, const glint_error *error); ///< the run fails, unless it was stopped; false
// Each of type bool returns false when the run has failed or was stopped.
bool cost_open_renderers(cost_study *study);
cost_shot cost_own_shot(const cost_study *study); ///< how a case is rendered when it is timed
/// Renders, encodes and times a case once, in memory.
bool cost_run(cost_study *study, cost_case *c);
/// A picture for the study itself, not one of the runs. `stats`: NULL, or what it took, work counted.
glint_status cost_take(cost_study *study, const cost_case *c, const cost_shot *how, glint_image **out,
                       glint_frame_stats *stats, glint_error *error);
/// Rays of a case as its plan expects them, for guessing how long it takes.
bool cost_expect(cost_study *study, const cost_case *c, double *rays);

// ---- cost/errors.c ----

/// Writes the settings of the reference that differ from the script's: ", with segments exact"; "" when there are none.
void cost_truth_name(const cost_study *study, char out[COST_LABEL_SIZE]);
/// The reference, its own error and the true decisions. `allowance_ms` is for all of its parts.
bool cost_make_reference(cost_study *study, double allowance_ms);
/// A case's first run, its work, errors and decisions, and pictures for the report.
bool cost_measure(cost_study *study, cost_case *c);

// ---- cost/timing.c ----

double cost_left_ms(const cost_study *study); ///< of the budget; infinite without one
/// The runs of all cases, one at a time, in random order; then more of those whose quartiles meet their neighbours', up to
/// the most runs or the budget's end.
bool cost_time_cases(cost_study *study);
void cost_summarize(cost_study *study); ///< computes the quartiles of the measured times
double cost_time_ms(const cost_case *c); ///< the median of the time that rows are compared by
double cost_quartile_range(const cost_case *c); ///< of the same
/// Returns whether a case's quartile range overlaps with neither neighbour in the order of times.
bool cost_is_apart(const cost_study *study, int index);
double cost_round_ms(const cost_study *study); ///< a run of every case that is not left out, as far as is known
/// Shows the current step on a terminal, with the expected time of this step and of the rest of the study.
void cost_show(const cost_study *study, const char *what, double step_ms, double left_ms);

// ---- cost/front.c ----

/// Adds the combinations that should be on the front, judging from the effect of each knob on its own.
bool cost_add_combinations(cost_study *study);
/// Fills in the fields that compare rows, and the advice.
void cost_judge(cost_study *study);

// ---- cost/present.c, cost/report.c ----

/// Pushes what the study has found as a table, for the modules in Lua; `study` is a cost_study. May raise.
void cost_push_study(lua_State *L, const void *study);
/// Makes a text of it: "table", "events", "plot" (of which there is none when no error is known) or "page".
bool cost_make(const cost_study *study, const char *what, void (*push)(lua_State *L, const void *study),
               glintL_made_text *out, char message[GLINTL_MESSAGE_SIZE]);
/// Prints the table, or lines for programs. False: the message is written.
bool cost_print(const cost_study *study, FILE *out, char message[GLINTL_MESSAGE_SIZE]);
/// Makes sure that the folder is there and can be written to. False: the message is written.
bool cost_report_check(const char *folder, char message[GLINTL_MESSAGE_SIZE]);
/// Returns the exit code; the message says what is wrong.
int cost_report_write(const cost_study *study, const char *folder, char message[GLINTL_MESSAGE_SIZE]);

#endif
