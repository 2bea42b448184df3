/// Whole files: read into memory, written so that they appear whole or not at all. Internal.
#ifndef GLINT_IMAGE_FILE_H
#define GLINT_IMAGE_FILE_H

#include "engine/glint.h"
#include "engine/base/open.h"
#include "engine/file/bytes.h"

/// A whole file as one glint_draft, see glint.h. SIGXFSZ and SIGPIPE are the caller's to ignore; then EFBIG and EPIPE are
/// reported like the others. draft.c
glint_status glint_file_write(const char *path, const void *bytes, size_t size, glint_error *error);

/// The one name of the place that a write to `path` goes to, whichever way `path` is spelled and through whichever links,
/// and whether the file and its folders are there or not; the caller's to free. NULL: out of memory. draft.c
char *glint_draft_place(const char *path);

/// Reads a whole file, which glint_open_file opens; *out is filled on success and its data is the caller's to free. More
/// than `limit` bytes is GLINT_ERR_FORMAT.
glint_status glint_file_read(const char *path, size_t limit, glint_bytes *out, glint_error *error);
/// The same for a picture: no more is read, and no more memory taken, than a .png or .pfm with its beginning can have. Of
/// what begins as neither there is the beginning.
glint_status glint_file_read_picture(const char *path, glint_bytes *out, glint_error *error);

// ---- leftover.c ----

#define GLINT_HOST_SIZE 48

/// This host's name, without slashes, cut at the room there is.
void glint_host_name(char out[GLINT_HOST_SIZE]);
/// Calls glint_drafts_collect on the folder of the file `path`, unless this process has looked through it lately. Any thread.
void glint_drafts_collect_beside(const char *path);
/// Notes and forgets the hidden name of a draft, which lives in between, for glint_drafts_abandon. Any thread.
void glint_draft_enlist(const char *temporary);
void glint_draft_delist(const char *temporary);

#endif
