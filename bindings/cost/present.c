// Converts the results of a study to Lua tables, for the modules that make its table, its JSON lines and its report.
#include <stddef.h>
#include <string.h>

#include "bindings/cost/cost.h"
#include "bindings/run/system.h"

static const unsigned char PLOT_LUA[] = {
#include "bindings/cost/plot.lua.h"
};
static const unsigned char PAGE_LUA[] = {
#include "bindings/cost/page.lua.h"
};
static const unsigned char LINES_LUA[] = {
#include "bindings/cost/lines.lua.h"
};
static const glintL_carried modules[] = {
    { "@plot.lua", PLOT_LUA, sizeof PLOT_LUA },
    { "@page.lua", PAGE_LUA, sizeof PAGE_LUA },
    { "@lines.lua", LINES_LUA, sizeof LINES_LUA },
};

static void cost_machine(const cost_study *study, char out[256])
{
    char model[128];
    glintL_processor_name(model);
    const glint_renderer *renderer = study->renderers[false][false];
    int threads = glint_renderer_threads(renderer);
    snprintf(out, 256, "%.100s, %d thread%s, %s, glint " GLINT_VERSION ", compiler %.40s", model, threads,
             threads == 1 ? "" : "s", glint_renderer_isa(renderer), __VERSION__);
}

// ---- The study as a Lua table: each sets a field of the table on top of the stack ----

static void set_value(lua_State *L, const char *name, cost_value value)
{
    if (value.text)
        glintL_set_text(L, name, value.text);
    else
        glintL_set_number(L, name, value.number);
}

typedef struct member {
    const char *name;
    size_t at;
    char kind; // 'd': a double, 'b': a bool, 'u': a uint64_t, 'f': a uint64_t that JSON lines print as a double
} member;

#define MEMBER(kind, type, name) \
    { \
#name, offsetof(type, name), kind \
    }
#define FLAG(name) \
    { \
#name, offsetof(cost_row, is_##name), 'b' \
    }

static const member ERROR[] = { MEMBER('d', glint_picture_error, rmse),     MEMBER('d', glint_picture_error, relmse),
                                MEMBER('d', glint_picture_error, max_code), MEMBER('d', glint_picture_error, over1),
                                MEMBER('d', glint_picture_error, over8),    MEMBER('d', glint_picture_error, flip) };
static const member TIME[] = { MEMBER('d', cost_quartiles, min), MEMBER('d', cost_quartiles, q1),
                               MEMBER('d', cost_quartiles, median), MEMBER('d', cost_quartiles, q3) };
static const member RAYS[] = { MEMBER('u', glint_ray_counts, primary), MEMBER('u', glint_ray_counts, shadow),
                               MEMBER('u', glint_ray_counts, mirror), MEMBER('u', glint_ray_counts, refraction),
                               MEMBER('u', glint_ray_counts, indirect) };
static const member WORK[] = { MEMBER('f', glint_work, tests),    MEMBER('f', glint_work, light_samples),
                               MEMBER('f', glint_work, powers),   MEMBER('f', glint_work, sites),
                               MEMBER('f', glint_work, overlaps), MEMBER('f', glint_work, lights_seen) };
static const member ROW[] = { FLAG(default), FLAG(front), FLAG(resolved),
                              FLAG(partial), FLAG(apart), MEMBER('d', cost_row, x_fastest) };

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void push_members(lua_State *L, const void *from, const member *list, size_t count)
{
    lua_newtable(L);
    for (size_t i = 0; i < count; i++) {
        const void *at = (const char *)from + list[i].at;
        if (list[i].kind == 'd')
            glintL_set_number(L, list[i].name, *(const double *)at);
        else if (list[i].kind == 'b')
            glintL_set_flag(L, list[i].name, *(const bool *)at);
        else if (list[i].kind == 'f')
            glintL_set_number(L, list[i].name, (double)*(const uint64_t *)at);
        else
            glintL_set_whole(L, list[i].name, *(const uint64_t *)at);
    }
}

static void set_settings(lua_State *L, const cost_study *study, const cost_case *c)
{
    lua_newtable(L);
    for (int i = 0, count = 0; i < cost_knob_count; i++) {
        if (c->choice[i] < 0)
            continue;
        lua_newtable(L);
        glintL_set_text(L, "knob", cost_knobs[i].name);
        set_value(L, "value", study->values[i].value[c->choice[i]]);
        lua_rawseti(L, -2, ++count);
    }
    lua_setfield(L, -2, "settings");
}

static void set_case(lua_State *L, const cost_study *study, const cost_case *c)
{
    lua_newtable(L);
    push_members(L, &c->time[COST_CPU], TIME, COUNT(TIME)); // rows are compared by this time
    lua_setfield(L, -2, "time");
    push_members(L, &c->time[COST_TOTAL], TIME, COUNT(TIME));
    lua_setfield(L, -2, "wall");
    glintL_set_number(L, "quartile_range", cost_quartile_range(c));
    glintL_set_number(L, "render", c->time[COST_RENDER].median);
    glintL_set_number(L, "tone", c->time[COST_TONE].median);
    glintL_set_number(L, "encode", c->time[COST_ENCODE].median);
    glintL_set_whole(L, "runs", c->run_count);
    glintL_set_whole(L, "frames", c->batch > 0 && !c->is_first_alone ? c->batch : 1);
    glintL_set_flag(L, "left_out", c->is_left_out);
    push_members(L, &c->stats.rays, RAYS, COUNT(RAYS));
    lua_setfield(L, -2, "rays");
    glintL_set_whole(L, "refined", c->stats.refined);
    if (c->estimate > 0)
        glintL_set_number(L, "estimate", c->estimate);
    if (c->is_counted) {
        push_members(L, &c->work, WORK, COUNT(WORK));
        lua_setfield(L, -2, "work");
    }
    glintL_set_whole(L, "wrong_object", c->wrong_object);
    glintL_set_whole(L, "wrong_shadow", c->wrong_shadow);
    set_settings(L, study, c);
    lua_setfield(L, -2, "case");
}

static void push_row(lua_State *L, const cost_study *study, const cost_row *row)
{
    const cost_knob *knob = cost_row_knob(row);
    const glint_picture_error *error = cost_row_error(study, row);
    char name[COST_LABEL_SIZE];
    cost_row_name(row, name);
    push_members(L, row, ROW, COUNT(ROW));
    glintL_set_whole(L, "index", row - study->rows);
    glintL_set_text(L, "name", name);
    glintL_set_text(L, "label", row->label);
    if (knob) {
        glintL_set_text(L, "knob", knob->name);
        set_value(L, "value", study->values[row->knob].value[row->value]);
    } else {
        glintL_set_text(L, "value", row->label);
    }
    glintL_set_flag(L, "other_time", knob && knob->is_other_time);
    glintL_set_flag(L, "own", row->measured == 0);
    glintL_set_whole(L, "difference", row->difference);
    set_case(L, study, &study->cases[row->measured]);
    if (error) {
        push_members(L, error, ERROR, COUNT(ERROR));
        lua_setfield(L, -2, "error");
    }
}

static void set_rows(lua_State *L, const cost_study *study)
{
    lua_newtable(L);
    for (int i = 0, count = 0; i < study->row_count; i++) {
        if (study->cases[study->rows[i].measured].run_count == 0)
            continue;
        push_row(L, study, &study->rows[i]);
        lua_rawseti(L, -2, ++count);
    }
    lua_setfield(L, -2, "rows");
}

static void set_reference(lua_State *L, const cost_study *study)
{
    char truth[COST_LABEL_SIZE];
    cost_truth_name(study, truth);
    glintL_set_text(L, "truth", truth);
    if (!study->reference)
        return;
    push_members(L, &study->reference_error, ERROR, COUNT(ERROR));
    glintL_set_number(L, "samples", study->reference_samples);
    lua_newtable(L);
    for (int i = 0; i < COST_REFERENCE_PARTS; i++) {
        lua_pushnumber(L, study->reference_seed[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "seeds");
    lua_setfield(L, -2, "reference");
}

void cost_push_study(lua_State *L, const void *context)
{
    const cost_study *study = context;
    const glint_render_desc *desc = &study->own->desc;
    char machine[256];
    cost_machine(study, machine);
    lua_newtable(L);
    glintL_set_text(L, "script", study->run->script);
    glintL_set_whole(L, "frame", study->run->explain_frame);
    glintL_set_number(L, "width", desc->width);
    glintL_set_number(L, "height", desc->height);
    glintL_set_number(L, "samples", desc->samples);
    glintL_set_whole(L, "runs", study->runs);
    glintL_set_flag(L, "complete", study->is_complete);
    glintL_set_number(L, "seconds", (glintL_now_ms() - study->start_ms) * 1e-3);
    glintL_set_text(L, "machine", machine);
    glintL_set_text(L, "advice", study->advice);
    set_reference(L, study);
    set_rows(L, study);
    lua_newtable(L);
    for (int i = 0; i < study->left_out_count; i++) {
        lua_pushstring(L, study->left_out[i]);
        lua_rawseti(L, -2, i + 1);
    }
    lua_setfield(L, -2, "left_out");
}

bool cost_make(const cost_study *study, const char *what, void (*push)(lua_State *L, const void *study),
               glintL_made_text *out, char message[GLINTL_MESSAGE_SIZE])
{
    return glintL_make_text(modules, COUNT(modules), what, push, study, out, message);
}

bool cost_print(const cost_study *study, FILE *out, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_made_text made;
    const bool good = cost_make(study, study->options->json ? "events" : "table", cost_push_study, &made, message);
    if (good)
        fwrite(made.text, 1, made.size, out);
    glintL_drop_text(&made);
    return good;
}
