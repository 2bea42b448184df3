/// Films and sheets of finished frames. Private to bindings/.
#ifndef GLINT_L_FILM_H
#define GLINT_L_FILM_H

#include "bindings/run/run.h"

// ---- film.c: films of a run ----

/// A film and its frames. While a run renders it, the frames are in the folder PATH.frames, so that nothing is lost when
/// the run is interrupted or no film can be made; the folder goes when the film is there.
typedef struct glintL_film {
    struct glintL_film *next;
    char *path, *pattern; ///< owned; pattern: of its frames, in a folder of their own
    glintL_film_kind kind;
    double fps;
    char **files; ///< owned, in order
    int64_t *numbers; ///< owned; of these frames, where glintL_film_add adds them
    size_t count, room;
} glintL_film;

/// Makes the film that frames to `path` go into known to the run, unless `path` is no film's. False: the message says
/// what is wrong.
bool glintL_film_open(glintL_run *run, const char *path, const glintL_render *render, double fps,
                      char message[GLINTL_MESSAGE_SIZE]);
/// A naming whose pattern is an open film's names that film's frames from now on.
void glintL_film_take(const glintL_run *run, glintL_naming *naming);
/// Adds a finished frame, in its place by number. False: out of memory.
bool glintL_film_add(glintL_film *film, int64_t number, const char *file);
/// Makes the films whose frames are all there, and removes the frames. False: the run has failed.
bool glintL_films_finish(glintL_run *run);
/// Says where the frames of films are that were not made.
void glintL_films_keep(const glintL_run *run);
void glintL_films_destroy(glintL_film *films);
/// Whether the files are whole and go together: size, bits and transfer; when `strict`, also what they were made by.
/// False: the message names the one that does not.
bool glintL_film_check_files(const glintL_film *film, bool strict, char message[GLINTL_MESSAGE_SIZE]);
/// Makes a film of its files. Returns the exit code; the message says what failed. Incomplete files are removed.
int glintL_film_make(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE]);

/// Reports that `done` frames are in the film.
void glintL_film_tell(const glintL_run *run, const glintL_film *film, size_t done);

// ---- film_pipe.c ----

bool glintL_has_ffmpeg(void);
/// The same for the kinds that ffmpeg makes.
int glintL_film_pipe(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE]);

#endif
