/// Films and sheets of finished frames. Private to bindings/.
#ifndef GLINT_L_FILM_H
#define GLINT_L_FILM_H

#include "bindings/run/run.h"

// ---- film.c: films of a run ----

/// A film and its frames. While a run renders them, the frames are stored in the folder PATH.frames, so that nothing is
/// lost if the run is interrupted or the film cannot be made. The folder is removed when the film exists.
typedef struct glintL_film {
    struct glintL_film *next;
    char *path, *pattern; ///< owned; pattern: of the frames' names, in the folder
    glintL_film_kind kind;
    double fps;
    char **files; ///< owned, in order
    int64_t *numbers; ///< owned; numbers of the frames, if glintL_film_add adds them
    size_t count, capacity;
    int lock; ///< the open folder PATH.frames, locked against other runs; -1: the file system has no locks
} glintL_film;

/// Opens the film at `path`, unless `path` is not a film. False: the message says what is wrong.
bool glintL_film_open(glintL_run *run, const char *path, const glintL_render *render, double fps,
                      char message[GLINTL_MESSAGE_SIZE]);
/// If a naming's pattern is an open film, changes it to that film's frames.
void glintL_film_take(const glintL_run *run, glintL_naming *naming);
/// Adds a finished frame, sorted by its number. False: out of memory.
bool glintL_film_add(glintL_film *film, int64_t number, const char *file);
/// Makes the films whose frames are complete, and removes the frames. False: the run has failed.
bool glintL_films_finish(glintL_run *run);
/// Reports where the frames of unfinished films are.
void glintL_films_keep(const glintL_run *run);
void glintL_films_destroy(glintL_film *films);
/// Checks that the files are whole and match in size, bits and transfer; when `strict`, also in their provenance.
/// False: the message names the file that does not match.
bool glintL_film_check_files(const glintL_film *film, bool strict, char message[GLINTL_MESSAGE_SIZE]);
/// Makes a film from its files. Returns the exit code; the message says what failed. Incomplete files are removed.
int glintL_film_make(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE]);

/// Reports that `done` frames are in the film.
void glintL_film_tell(const glintL_run *run, const glintL_film *film, size_t done);

// ---- film_pipe.c ----

bool glintL_has_ffmpeg(void);
/// Makes a film in one of the formats that ffmpeg writes.
int glintL_film_pipe(glintL_run *run, const glintL_film *film, char message[GLINTL_MESSAGE_SIZE]);

#endif
