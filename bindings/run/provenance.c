// The text entries of a picture's file: key, script, hash of its text, parameters, frame, options, place in a sweep.
// They also show whether files belong together.
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/run/run.h"

#define TEXT_MAX 65000 // a PNG text holds 64 KiB

// ---- Writing ----

static void add(glintL_provenance *out, const char *keyword, const char *value)
{
    if (value && *value && strlen(value) < TEXT_MAX)
        out->text[out->count++] = (glint_text) { keyword, value };
}

static void list_options(const glintL_render *render, char *out, size_t capacity)
{
    char value[96];
    size_t used = 0;
    out[0] = '\0';
    for (int field = 0; field < GLINTL_RENDER_FIELDS && used < capacity; field++)
        if (glintL_render_spell(render, field, value))
            used += (size_t)snprintf(out + used, capacity - used, "%s%s=%s", used ? "\n" : "",
                                     glintL_render_fields[field].name, value);
}

// Lists the axes of the script's sweep and of --sweep. Returns false when out of memory.
static bool join_sweeps(glintL_provenance *out, const glintL_run *run, const glintL_work *work)
{
    const glintL_request *request = &run->request;
    size_t capacity = 1 + (work->sweep ? strlen(work->sweep) : 0), used = 0;
    for (size_t i = request->set_count - request->swept_count; i < request->set_count; i++)
        capacity += strlen(request->sets[i].name) + strlen(request->sets[i].text) + 2;
    if (capacity == 1)
        return true;
    out->sweep = malloc(capacity);
    if (!out->sweep)
        return false;
    used = (size_t)snprintf(out->sweep, capacity, "%s", work->sweep ? work->sweep : "");
    for (size_t i = request->set_count - request->swept_count; i < request->set_count; i++)
        used += (size_t)snprintf(out->sweep + used, capacity - used, "%s%s=%s", used ? "\n" : "", request->sets[i].name,
                                 request->sets[i].text);
    return true;
}

// Joins the names of the sweep's sheet and of the parameters. Returns false when out of memory.
static bool join_names(glintL_provenance *out, const glintL_run *run, const glintL_work *work)
{
    const char *own = work->names ? work->names : "", *params = run->names_text ? run->names_text : "";
    const size_t capacity = strlen(own) + strlen(params) + 1;
    if (capacity == 1)
        return true;
    out->names = malloc(capacity);
    if (out->names)
        snprintf(out->names, capacity, "%s%s", own, params);
    return out->names;
}

bool glintL_provenance_take(glintL_provenance *out, const glintL_run *run, const glintL_work *work,
                            const glintL_file *file)
{
    memset(out, 0, sizeof *out);
    if (!join_sweeps(out, run, work) || !join_names(out, run, work)) {
        glintL_provenance_drop(out);
        return false;
    }
    snprintf(out->frame, sizeof out->frame, "%" PRId64, work->index - run->point_first);
    list_options(&work->render, out->options, sizeof out->options);
    add(out, "Software", "glint " GLINT_VERSION);
    GLINTL_SPELL_KEY(out->key, file->key, *work->unfinished);
    out->text[out->count++] = (glint_text) { "glint:key", out->key };
    add(out, "glint:unfinished", work->unfinished);
    add(out, "glint:script", run->script);
    add(out, "glint:source", run->source);
    add(out, "glint:params", run->params_text);
    add(out, "glint:frame", out->frame);
    add(out, "glint:pass", file->pass == GLINT_PASS_BEAUTY ? NULL : glintL_pass_name(work, file->pass, out->pass));
    add(out, "glint:options", out->options);
    add(out, "glint:sweep", out->sweep);
    add(out, "glint:names", out->names);
    add(out, "glint:encoder", glint_encoder_name(work->render.encode));
    add(out, "glint:whole", file->whole);
    return true;
}

void glintL_provenance_drop(glintL_provenance *provenance)
{
    free(provenance->sweep);
    free(provenance->names);
    provenance->sweep = provenance->names = NULL;
}

// ---- Comparing ----

const char *glintL_find_line(const char *lines, const char *name, size_t name_length, size_t *length)
{
    while (lines && *lines) {
        size_t size = strcspn(lines, "\n");
        if (size > name_length && lines[name_length] == '=' && memcmp(lines, name, name_length) == 0) {
            *length = size;
            return lines;
        }
        lines += size + (lines[size] == '\n');
    }
    return NULL;
}

typedef struct file { // for messages
    const glint_picture *picture;
    const char *path;
} file;

static bool differ(char *message, const file *a, const char *has, const file *b, const char *has_instead)
{
    return glintL_complain(message, "%.200s was rendered with %.150s, but %.200s with %.150s", b->path, has_instead,
                           a->path, has);
}

// Checks that both files have the same text.
static bool match_text(const file *a, const file *b, const char *keyword, const char *what, char *message)
{
    const char *one = glint_picture_text(a->picture, keyword), *other = glint_picture_text(b->picture, keyword);
    char has[200], has_instead[200];
    if ((!one && !other) || (one && other && strcmp(one, other) == 0))
        return true;
    snprintf(has, sizeof has, "%s%s%.100s", one ? "" : "no ", what, one ? one : "");
    snprintf(has_instead, sizeof has_instead, "%s%s%.100s", other ? "" : "no ", what, other ? other : "");
    return differ(message, a, has, b, has_instead);
}

static const char *swept_line(const file *a, const char *line, size_t name_length)
{
    size_t length;
    return glintL_find_line(glint_picture_text(a->picture, "glint:sweep"), line, name_length, &length);
}

// Returns whether every line of a's text is also in b's, except the values that a sweep changes.
static bool match_lines(const file *a, const file *b, const char *keyword, char *message)
{
    const char *lines = glint_picture_text(a->picture, keyword);
    const char *others = glint_picture_text(b->picture, keyword);
    while (lines && *lines) {
        size_t size = strcspn(lines, "\n"), name = strcspn(lines, "="), length = 0;
        const char *other = glintL_find_line(others, lines, name, &length);
        if ((!other || length != size || memcmp(other, lines, size) != 0) && !swept_line(a, lines, name)) {
            char has[200], has_instead[200];
            snprintf(has, sizeof has, "%.*s", (int)(size < 150 ? size : 150), lines);
            snprintf(has_instead, sizeof has_instead, "%.*s", (int)(length < 150 ? length : 150), other ? other : "");
            return differ(message, a, has, b, other ? has_instead : "none");
        }
        lines += size + (lines[size] == '\n');
    }
    return true;
}

bool glintL_provenance_match(const glint_picture *a, const char *a_path, const glint_picture *b, const char *b_path,
                             bool strict, char message[GLINTL_MESSAGE_SIZE])
{
    const file one = { a, a_path }, other = { b, b_path };
    bool keyed = glint_picture_text(a, "glint:key") != NULL, other_keyed = glint_picture_text(b, "glint:key") != NULL;
    if (keyed != other_keyed)
        return differ(message, &one, keyed ? "a key of glint" : "no key of glint", &other,
                      other_keyed ? "a key of glint" : "no key of glint");
    return match_text(&one, &other, "Software", "", message) &&
           match_text(&one, &other, "glint:script", "script ", message) &&
           match_text(&one, &other, "glint:source", "script text ", message) &&
           (!strict ||
            (match_text(&one, &other, "glint:pass", "pass ", message) &&
             match_lines(&one, &other, "glint:params", message) && match_lines(&other, &one, "glint:params", message) &&
             match_lines(&one, &other, "glint:options", message)));
}
