// Films of a run: the frames are stored in a folder next to the film, and joined when all of them exist.
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bindings/run/film.h"
#include "bindings/run/system.h"

// ---- Names ----

// Returns "PATH.frames/%04d.png", with each '%' of the path doubled; the caller frees it. NULL: out of memory.
static char *pattern_of(const char *path)
{
    size_t used = 0, capacity = 2 * strlen(path) + 32;
    char *out = malloc(capacity);
    for (; out && *path; path++) {
        if (*path == '%')
            out[used++] = '%';
        out[used++] = *path;
    }
    if (out)
        snprintf(out + used, capacity - used, ".frames/%%04d.png");
    return out;
}

// ---- The films of a run ----

static glintL_film *find(const glintL_run *run, const char *path)
{
    glintL_film *film = run->films;
    while (film && strcmp(film->path, path) != 0)
        film = film->next;
    return film;
}

static glintL_film *add_film(glintL_run *run, const char *path, glintL_film_kind kind, double fps)
{
    glintL_film *film = calloc(1, sizeof *film), **end = &run->films;
    if (!film)
        return NULL;
    film->path = strdup(path);
    film->pattern = pattern_of(path);
    film->kind = kind;
    film->fps = fps;
    film->lock = -1;
    if (!film->path || !film->pattern) {
        glintL_films_destroy(film);
        return NULL;
    }
    while (*end)
        end = &(*end)->next;
    *end = film;
    return film;
}

static bool refuse(char *message, const char *path, const char *why)
{
    return glintL_complain(message, "output: '%.200s' is a film: %s", path, why);
}

static void warn_no_ffmpeg(glintL_run *run, const glintL_film *film)
{
    if (film->kind != GLINTL_FILM_APNG && !glintL_has_ffmpeg())
        glintL_run_warn(run, "ffmpeg is not installed: the frames of %s are rendered and remain in %s.frames",
                        film->path, film->path);
}

static void name_folder(const glintL_film *film, char folder[GLINTL_PATH_SIZE])
{
    snprintf(folder, GLINTL_PATH_SIZE, "%s.frames", film->path);
}

// Makes and locks the folder of the frames. False: another run has locked it. Other failures show when a frame is
// written.
static bool lock_folder(glintL_film *film)
{
    char folder[GLINTL_PATH_SIZE];
    struct stat info;
    name_folder(film, folder);
    do { // again if another run has just removed the folder
        if (film->lock >= 0)
            close(film->lock);
        film->lock = glintL_make_folders(folder) ? open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
        if (film->lock >= 0 && flock(film->lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
            return false;
    } while (film->lock >= 0 && fstat(film->lock, &info) == 0 && info.st_nlink == 0);
    return true;
}

bool glintL_film_open(glintL_run *run, const char *path, const glintL_render *render, double fps,
                      char message[GLINTL_MESSAGE_SIZE])
{
    glintL_film_kind kind = glintL_film_kind_of(path, run->request.apng);
    if (strcmp(path, "none") == 0 || run->measures)
        return true;
    if (run->request.apng && kind != GLINTL_FILM_APNG)
        return glintL_complain(message, "--apng: an output in .png expected, got '%.200s'", path);
    if (kind == GLINTL_FILM_NONE)
        return true;
    if (run->request.is_untrusted)
        return refuse(message, path, "an untrusted script can write only pictures; make the film with glint assemble");
    fps = run->request.fps > 0 ? run->request.fps : fps;
    if (run->request.selection.shard_count > 1)
        return refuse(message, path,
                      "a film needs all frames of one run; write the shards as pictures, with a pattern such as "
                      "%04d.png, and then use glint assemble");
    if (render->file_passes || render->derivative_count || *render->light_passes)
        return refuse(message, path,
                      "a film cannot hold passes; write pictures, and make a film of each pass with glint assemble");
    if (render->desc.alpha && kind != GLINTL_FILM_APNG)
        return refuse(message, path, "this format cannot hold alpha; an animated PNG can (.apng, or .png with --apng)");
    if (kind == GLINTL_FILM_GIF && fps > 50)
        return refuse(message, path, "a GIF has at most 50 frames a second; --fps 50 or less expected");
    glintL_film *film = find(run, path);
    if (film && film->fps != fps)
        return refuse(message, path, "the animations of this film have different fps; expected --fps");
    if (film)
        return true;
    film = add_film(run, path, kind, fps);
    if (!film)
        return glintL_complain(message, "out of memory");
    if (!lock_folder(film))
        return refuse(message, path, "another run is making it now; wait for the end of that run, or choose another name");
    warn_no_ffmpeg(run, film);
    return true;
}

void glintL_film_take(const glintL_run *run, glintL_naming *naming)
{
    glintL_film *film = naming->pattern ? find(run, naming->pattern) : NULL;
    if (film)
        *naming = (glintL_naming) { .pattern = film->pattern, .film = film };
}

static bool grow(glintL_film *film)
{
    const size_t capacity = film->capacity ? 2 * film->capacity : 64;
    char **files = realloc(film->files, capacity * sizeof *files);
    if (files)
        film->files = files;
    int64_t *numbers = files ? realloc(film->numbers, capacity * sizeof *numbers) : NULL;
    if (!numbers)
        return false;
    film->numbers = numbers;
    film->capacity = capacity;
    return true;
}

bool glintL_film_add(glintL_film *film, int64_t number, const char *file)
{
    size_t at = film->count;
    char *copy = film->count < film->capacity || grow(film) ? strdup(file) : NULL;
    if (!copy)
        return false;
    for (; at > 0 && film->numbers[at - 1] > number; at--) {
        film->files[at] = film->files[at - 1];
        film->numbers[at] = film->numbers[at - 1];
    }
    film->files[at] = copy;
    film->numbers[at] = number;
    film->count++;
    return true;
}

void glintL_films_destroy(glintL_film *films)
{
    while (films) {
        glintL_film *next = films->next;
        for (size_t i = 0; i < films->count; i++)
            free(films->files[i]);
        if (films->lock >= 0) {
            char folder[GLINTL_PATH_SIZE];
            name_folder(films, folder);
            if (films->count == 0)
                rmdir(folder); // unless it has frames
            close(films->lock);
        }
        free(films->files);
        free(films->numbers);
        free(films->path);
        free(films->pattern);
        free(films);
        films = next;
    }
}

// ---- Making ----

static bool match_first(const glintL_film *film, size_t i, const glint_picture *first, const glint_picture *picture,
                        char *message)
{
    int width = glint_picture_width(first), height = glint_picture_height(first), bits = glint_picture_bits(first);
    if (glint_picture_width(picture) != width || glint_picture_height(picture) != height)
        return glintL_complain(message, "%.200s: %dx%d pixels expected, as in %.200s, got %dx%d", film->files[i], width,
                               height, film->files[0], glint_picture_width(picture), glint_picture_height(picture));
    if (glint_picture_bits(picture) == bits && glint_picture_transfer(picture) == glint_picture_transfer(first) &&
        glint_picture_channels(picture) == glint_picture_channels(first))
        return true;
    return glintL_complain(message, "%.200s: expected the same bits, transfer and channels as in %.200s",
                           film->files[i], film->files[0]);
}

// Refuses transparency except in an APNG, the only film that can store it.
static bool check_channels(const glintL_film *film, const glint_picture *first, char *message)
{
    const int channels = glint_picture_channels(first);
    if (film->kind == GLINTL_FILM_APNG) {
        if ((channels == 3 || channels == 4) && glint_picture_bits(first) <= 16)
            return true;
        return glintL_complain(message, "%.200s: a .png of RGB or RGBA expected for an APNG", film->files[0]);
    }
    if (channels == 1 || channels == 3)
        return true;
    return glintL_complain(
        message, "%.200s: has alpha, which %.200s cannot hold; an animated PNG can (.apng, or .png with --apng)",
        film->files[0], film->path);
}

bool glintL_film_check_files(const glintL_film *film, bool strict, char message[GLINTL_MESSAGE_SIZE])
{
    glint_picture *first = NULL;
    bool good = true;
    for (size_t i = 0; i < film->count && good; i++) {
        glint_picture *picture = NULL;
        glint_error error;
        if (glint_picture_read(film->files[i], false, &picture, &error)) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
            good = false;
        } else if (!first) {
            first = picture;
            continue;
        } else {
            good = match_first(film, i, first, picture, message) &&
                   (!strict || glintL_provenance_match(first, film->files[0], picture, film->files[i], true, message));
        }
        glint_picture_destroy(picture);
    }
    good = good && check_channels(film, first, message);
    glint_picture_destroy(first);
    return good;
}

void glintL_film_tell(const glintL_run *run, const glintL_film *film, size_t done)
{
    if (run->reporter.making)
        run->reporter.making(run->reporter.context, film->path, done, film->count);
}

static glint_status add_frames(const glintL_run *run, const glintL_film *film, glint_apng *apng, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (size_t i = 0; i < film->count && !status; i++) {
        glint_picture *picture = NULL;
        glintL_film_tell(run, film, i);
        if (run->interrupted)
            return GLINT_ERR_CANCELLED;
        status = glint_picture_read(film->files[i], true, &picture, error);
        if (!status)
            status = glint_apng_add(apng, picture, error);
        glint_picture_destroy(picture);
    }
    return status;
}

static glint_status make_apng(const glintL_run *run, const glintL_film *film, glint_error *error)
{
    glint_picture *first = NULL;
    glint_apng *apng = NULL;
    glint_status status = glint_picture_read(film->files[0], false, &first, error);
    if (status)
        return status;
    glint_apng_desc desc = { glint_picture_width(first),
                             glint_picture_height(first),
                             glint_picture_bits(first),
                             glint_picture_channels(first) == 4,
                             glint_picture_transfer(first),
                             (uint32_t)film->count,
                             film->fps,
                             0,
                             GLINT_ENCODE_SMALL };
    glint_picture_destroy(first);
    status = glint_apng_create(film->path, &desc, &apng, error);
    if (!status)
        status = add_frames(run, film, apng, error);
    if (!status)
        status = glint_apng_finish(apng, error);
    glint_apng_destroy(apng);
    return status;
}

int glintL_film_make(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE])
{
    glint_error error = { .message = "interrupted" };
    if (film->kind != GLINTL_FILM_APNG)
        return glintL_film_pipe(run, film, message);
    glint_status status = make_apng(run, film, &error);
    snprintf(message, GLINTL_MESSAGE_SIZE, "%s", error.message);
    return glintL_run_exit_code(status);
}

static void remove_frames(const glintL_run *run, glintL_film *film)
{
    char folder[GLINTL_PATH_SIZE];
    for (size_t i = 0; i < film->count; i++) {
        unlink(film->files[i]);
        free(film->files[i]);
    }
    film->count = 0;
    name_folder(film, folder);
    if (rmdir(folder) != 0 && errno != ENOENT)
        glintL_run_note(run, "%s: not removed, because it contains other files", folder);
}

bool glintL_films_finish(glintL_run *run)
{
    char message[GLINTL_MESSAGE_SIZE];
    for (glintL_film *film = run->films; film && !run->exit_code; film = film->next) {
        if (film->count == 0)
            continue;
        int code = GLINTL_EXIT_USAGE;
        size_t count = film->count;
        if (!run->interrupted && glintL_film_check_files(film, false, message))
            code = glintL_film_make(run, film, message);
        if (run->interrupted || code)
            return glintL_run_fail(run, code, 0, "%s", message);
        remove_frames(run, film);
        if (run->reporter.figure)
            run->reporter.figure(run->reporter.context, "film", film->path, (int64_t)count);
    }
    if (run->exit_code)
        return false;
    glintL_films_destroy(run->films); // a later run in the same script starts its films anew
    run->films = NULL;
    return true;
}

void glintL_films_keep(const glintL_run *run)
{
    for (const glintL_film *film = run->films; film; film = film->next)
        if (film->count > 0)
            glintL_run_note(run, "%zu finished frames of %s are in %s.frames; the same command continues from them",
                            film->count, film->path, film->path);
}
