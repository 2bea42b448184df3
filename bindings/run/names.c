// File names: a pattern, the frame's number and the pass.
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "bindings/run/run.h"

#define DIGITS_MAX 18 // digits of a number, at most

// A placeholder for the number in a pattern. The placeholder begins with '%' or '#'.
typedef struct placeholder {
    size_t length; // length in the pattern; 0: invalid
    int digits; // -1: an escaped '%' or '#'
} placeholder;

static placeholder read_placeholder(const char *text)
{
    placeholder found = { 0, 0 };
    if (*text == '#') {
        found.length = strspn(text, "#");
        found.digits = found.length <= DIGITS_MAX ? (int)found.length : DIGITS_MAX;
        return found;
    }
    if (text[1] == '%' || text[1] == '#')
        return (placeholder) { 2, -1 };
    size_t figures = strspn(text + 1, "0123456789");
    if (text[1 + figures] != 'd' || figures > 3 || (figures > 0 && text[1] != '0'))
        return found;
    found.digits = atoi(text + 1);
    found.length = found.digits <= DIGITS_MAX ? figures + 2 : 0;
    return found;
}

const char *glintL_base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// Returns whether `at` is a placeholder for the number. "%d" may be anywhere, "#" only in the last part of the path,
// because folders have names such as "shot#3".
static bool is_placeholder(const char *pattern, const char *at)
{
    return *at == '%' || (*at == '#' && at >= glintL_base_name(pattern));
}

// Returns whether the path is an existing pipe or device. It is written directly under its own name, and no other file
// is made next to it.
bool glintL_name_is_special(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

bool glintL_name_is_plain(const char *name, size_t length)
{
    bool good = length > 0 && length <= 200 && name[0] != '.' && name[0] != '-';
    for (size_t i = 0; good && i < length; i++)
        good = name[i] != '/' && (unsigned char)name[i] >= ' ' && name[i] != 0x7f;
    return good;
}

// Returns the dot of ".png", ".svg", ".pdf", ".pfm", ".npy" or ".exr"; NULL: another extension, or an empty name before
// the dot.
static const char *ending(const char *path)
{
    static const char *const known[] = { ".png", ".svg", ".pdf", ".pfm", ".npy", ".exr" };
    size_t length = strlen(path);
    if (length < 5 || path[length - 5] == '/')
        return NULL;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(path + length - 4, known[i]) == 0)
            return path + length - 4;
    return NULL;
}

static bool ends_in(const char *path, const char *wanted)
{
    const char *dot = ending(path);
    return dot && strcasecmp(dot, wanted) == 0;
}

bool glintL_name_is_linear(const char *path) { return ends_in(path, ".pfm") || ends_in(path, ".npy") || ends_in(path, ".exr"); }

bool glintL_name_is_vector(const char *path) { return ends_in(path, ".svg") || ends_in(path, ".pdf"); }

bool glintL_name_is_exr(const char *path) { return ends_in(path, ".exr"); }

glintL_film_kind glintL_film_kind_of(const char *path, bool apng)
{
    static const struct {
        const char *ending;
        glintL_film_kind kind;
    } kinds[] = { { ".mp4", GLINTL_FILM_MP4 },
                  { ".webm", GLINTL_FILM_WEBM },
                  { ".gif", GLINTL_FILM_GIF },
                  { ".apng", GLINTL_FILM_APNG } };
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t size = strlen(kinds[i].ending);
        if (length > size && path[length - size - 1] != '/' && strcasecmp(path + length - size, kinds[i].ending) == 0)
            return kinds[i].kind;
    }
    if (apng && length > 4 && path[length - 5] != '/' && strcasecmp(path + length - 4, ".png") == 0)
        return GLINTL_FILM_APNG;
    return GLINTL_FILM_NONE;
}

bool glintL_name_check(const char *pattern, char message[GLINTL_MESSAGE_SIZE])
{
    const char *wrong = NULL;
    if (strcmp(pattern, "none") == 0)
        return true;
    for (const char *at = pattern; *at && !wrong;) {
        size_t length = is_placeholder(pattern, at) ? read_placeholder(at).length : 1;
        if (length == 0)
            wrong = "a place for the frame number such as %04d or ####, and %% for a per cent sign";
        at += length;
    }
    bool is_film = glintL_film_kind_of(pattern, false) != GLINTL_FILM_NONE;
    if (!wrong && is_film && glintL_name_has_number(pattern))
        wrong = "a film's name without a place for the frame number";
    if (!wrong && !is_film && !ending(pattern) && !glintL_name_is_special(pattern))
        wrong = "a file name ending in .png, .svg, .pdf, .pfm, .npy or .exr, or a film's in .mp4, .webm, .gif or .apng";
    if (!wrong && glintL_name_is_exr(pattern) && !glint_exr_library())
        wrong = "a file name ending in .png, .svg, .pdf, .pfm or .npy, as this build has no OpenEXR (libopenexr-dev),";
    if (!wrong && ends_in(pattern, ".pdf") && !glint_cairo_version())
        wrong = "a file name ending in .png or .svg, as this build has no cairo (libcairo2-dev),";
    if (!wrong && strlen(pattern) >= GLINTL_PATH_SIZE - 64)
        wrong = "a shorter file name";
    if (wrong)
        snprintf(message, GLINTL_MESSAGE_SIZE, "%s expected, got '%.200s'", wrong, pattern);
    return !wrong;
}

bool glintL_name_has_number(const char *pattern)
{
    for (const char *at = pattern; *at;) {
        placeholder found = is_placeholder(pattern, at) ? read_placeholder(at) : (placeholder) { 1, -1 };
        if (found.digits >= 0)
            return true;
        at += found.length ? found.length : 1;
    }
    return glintL_name_is_special(pattern);
}

// Copies the pattern with the number inserted. False: too long.
static bool fill(const glintL_naming *naming, int64_t number, char path[GLINTL_PATH_SIZE])
{
    size_t used = 0;
    for (const char *at = naming->pattern; *at && used < GLINTL_PATH_SIZE - 1;) {
        placeholder found = { 1, -1 };
        if (!naming->is_plain && is_placeholder(naming->pattern, at))
            found = read_placeholder(at);
        if (found.digits >= 0)
            used += (size_t)snprintf(path + used, GLINTL_PATH_SIZE - used, "%0*" PRId64, found.digits, number);
        else
            path[used++] = at[found.length == 2 ? 1 : 0];
        at += found.length ? found.length : 1;
    }
    if (used >= GLINTL_PATH_SIZE)
        return false;
    path[used] = '\0';
    return used < GLINTL_PATH_SIZE - 64;
}

bool glintL_name_file(const glintL_naming *naming, int64_t number, const char *pass, char path[GLINTL_PATH_SIZE])
{
    char insert[96] = "", tail[8] = "";
    if (!fill(naming, number, path))
        return false;
    if (naming->is_numbered && (naming->is_plain || !glintL_name_has_number(naming->pattern)))
        snprintf(insert, sizeof insert, "_%04" PRId64, number);
    if (strcmp(pass, "beauty") != 0) {
        size_t used = strlen(insert);
        const bool light = strncmp(pass, "light:", 6) == 0;
        snprintf(insert + used, sizeof insert - used, ".%s", pass);
        for (char *at = insert + used + 1; *at; at++) // d:NAME and light:NAME may contain any characters
            if (!isalnum((unsigned char)*at) && *at != '-')
                *at = '_';
        if (light)
            insert[used + 6] = '.'; // x.light.key.png
    }
    const char *dot = ending(path);
    size_t stem = dot ? (size_t)(dot - path) : strlen(path);
    if (insert[0]) {
        snprintf(tail, sizeof tail, "%s", path + stem);
        snprintf(path + stem, GLINTL_PATH_SIZE - stem, "%s%s", insert, tail);
    }
    return true;
}

const char *glintL_pass_name(const glintL_work *work, glint_pass pass, char room[GLINTL_PASS_NAME_SIZE])
{
    if (pass < GLINT_PASS_DERIVATIVE)
        return glint_pass_name(pass);
    if (pass < GLINT_PASS_LIGHT)
        snprintf(room, GLINTL_PASS_NAME_SIZE, "d:%s", work->render.derivative[pass - GLINT_PASS_DERIVATIVE]);
    else
        snprintf(room, GLINTL_PASS_NAME_SIZE, "light:%s", glint_plan_light_pass(work->plan, (size_t)pass - GLINT_PASS_LIGHT));
    return room;
}
