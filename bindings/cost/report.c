// The report of glint cost: a page that needs no network, its plot as a separate file, and the pictures.
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/cost/cost.h"

#define PAGE_MAX 12000000 // bytes of pictures embedded in the page, at most

static const char PAGE[] = {
#include "bindings/cost/page.html.h"
};
static const char STYLE[] = {
#include "bindings/cost/plot.css.h"
};

// ---- Pictures ----

// Names the pictures "samples_16" after the first row that shows the case; the base is "own".
static void name_pictures(const cost_study *study, int index, char title[COST_LABEL_SIZE], char file[COST_LABEL_SIZE])
{
    for (int i = study->row_count - 1; i >= 0; i--)
        if (study->rows[i].measured == index)
            cost_row_name(&study->rows[i], title);
    if (index == 0)
        snprintf(title, COST_LABEL_SIZE, "the script's own setting");
    snprintf(file, COST_LABEL_SIZE, "%s", index == 0 ? "own" : title);
    for (char *at = file; *at; at++)
        if (*at == ' ' || *at == '=')
            *at = '_';
}

// Returns whether a picture is worth showing: not if it equals the script's own (with another encoder, for example).
static bool has_picture(const cost_study *study, int index)
{
    const cost_case *c = &study->cases[index], *own = &study->cases[0];
    return c->picture && c->difference &&
           (index == 0 || c->picture_size != own->picture_size ||
            memcmp(c->picture, own->picture, c->picture_size) != 0);
}

// Returns whether the pictures are embedded in the page. Otherwise they are separate files, to keep the page small.
static bool is_light(const cost_study *study)
{
    size_t sum = 0;
    for (int i = 0; i < study->case_count; i++)
        if (has_picture(study, i))
            sum += study->cases[i].picture_size + study->cases[i].difference_size;
    return sum <= PAGE_MAX;
}

static void set_bytes(lua_State *L, const char *name, const void *bytes, size_t size)
{
    lua_pushlstring(L, bytes, size);
    lua_setfield(L, -2, name);
}

static void push_report(lua_State *L, const void *context)
{
    const cost_study *study = context;
    char title[COST_LABEL_SIZE], file[COST_LABEL_SIZE];
    cost_push_study(L, study);
    set_bytes(L, "page", PAGE, sizeof PAGE);
    set_bytes(L, "style", STYLE, sizeof STYLE);
    glintL_set_text(L, "live", study->live);
    glintL_set_flag(L, "is_light", is_light(study));
    lua_newtable(L);
    for (int i = 0, count = 0; i < study->case_count && study->cases[0].picture; i++) {
        const cost_case *c = &study->cases[i];
        if (!has_picture(study, i))
            continue;
        name_pictures(study, i, title, file);
        lua_newtable(L);
        set_bytes(L, "title", title, strlen(title));
        set_bytes(L, "file", file, strlen(file));
        set_bytes(L, "picture", c->picture, is_light(study) ? c->picture_size : 0);
        set_bytes(L, "difference", c->difference, is_light(study) ? c->difference_size : 0);
        lua_rawseti(L, -2, ++count);
    }
    lua_setfield(L, -2, "pictures");
}

// ---- Files ----

static bool make_folders(const char *folder)
{
    char path[GLINTL_PATH_SIZE];
    snprintf(path, sizeof path, "%s", folder);
    for (char *at = path + 1; *at; at++) {
        if (*at != '/')
            continue;
        *at = '\0';
        mkdir(path, 0777); // a failure shows in the check below
        *at = '/';
    }
    const int why = mkdir(path, 0777) == 0 ? 0 : errno;
    struct stat info;
    if (stat(path, &info) == 0) {
        errno = ENOTDIR;
        return S_ISDIR(info.st_mode);
    }
    errno = why;
    return false;
}

bool cost_report_check(const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    if (!*folder || strlen(folder) > GLINTL_PATH_SIZE - 2 * COST_LABEL_SIZE)
        return glintL_complain(message, "a folder to write to expected, got '%.200s'", folder);
    errno = 0;
    if (make_folders(folder) && access(folder, W_OK | X_OK) == 0)
        return true;
    const int why = errno;
    return glintL_complain(message, "a folder to write to expected, got '%.600s': %s", folder, strerror(why));
}

static glint_status write_file(const char *folder, const char *name, const void *bytes, size_t size, glint_error *error)
{
    char path[GLINTL_PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return glintL_write_text(path, bytes, size, error);
}

static glint_status write_pictures(const cost_study *study, const char *folder, glint_error *error)
{
    char title[COST_LABEL_SIZE], file[COST_LABEL_SIZE], name[COST_LABEL_SIZE + 16];
    glint_status status = GLINT_OK;
    for (int i = 0; i < study->case_count && !status && !is_light(study); i++) {
        const cost_case *c = &study->cases[i];
        if (!has_picture(study, i))
            continue;
        name_pictures(study, i, title, file);
        snprintf(name, sizeof name, "%s.png", file);
        status = write_file(folder, name, c->picture, c->picture_size, error);
        snprintf(name, sizeof name, "%s_error.png", file);
        if (!status)
            status = write_file(folder, name, c->difference, c->difference_size, error);
    }
    return status;
}

// Removes the plot of an earlier study from the folder, if this study has no errors to draw.
static glint_status remove_plot(const char *folder, glint_error *error)
{
    char path[GLINTL_PATH_SIZE];
    snprintf(path, sizeof path, "%s/plot.svg", folder);
    if (unlink(path) == 0 || errno == ENOENT)
        return GLINT_OK;
    snprintf(error->message, sizeof error->message, "%.400s: %s", path, strerror(errno));
    return GLINT_ERR_IO;
}

int cost_report_write(const cost_study *study, const char *folder, char message[GLINTL_MESSAGE_SIZE])
{
    glintL_made_text plot = { 0 }, page = { 0 };
    glint_error error;
    glint_status status = GLINT_ERR_NOMEM;
    if (cost_make(study, "plot", push_report, &plot, message) &&
        cost_make(study, "page", push_report, &page, message)) {
        status = write_pictures(study, folder, &error);
        if (!status)
            status =
                plot.text ? write_file(folder, "plot.svg", plot.text, plot.size, &error) : remove_plot(folder, &error);
        if (!status)
            status = write_file(folder, "index.html", page.text, page.size, &error);
        if (status)
            snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    }
    glintL_drop_text(&plot);
    glintL_drop_text(&page);
    return glintL_run_exit_code(status);
}
