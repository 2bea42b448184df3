/// Whole files: read into memory, and written so that they appear complete or not at all. Internal.
#ifndef GLINT_IMAGE_FILE_H
#define GLINT_IMAGE_FILE_H

#include "engine/base/open.h"
#include "engine/files/picture/bytes.h"
#include "engine/glint_types.h"

/// Writes a whole file as one glint_draft, see glint_files.h. The caller must ignore SIGXFSZ and SIGPIPE; then EFBIG and
/// EPIPE are reported like other errors. draft.c
glint_status glint_file_write(const char *path, const void *bytes, size_t size, glint_error *error);

/// Returns the canonical path that a write to `path` goes to: the same for every spelling of `path` and through any
/// links, whether or not the file and its folders exist. The caller frees it. NULL: out of memory. draft.c
char *glint_draft_place(const char *path);

/// Reads a whole file, which glint_open_file opens. *out is filled on success and the caller frees its data. More than
/// `limit` bytes is GLINT_ERR_FORMAT.
glint_status glint_file_read(const char *path, size_t limit, glint_bytes *out, glint_error *error);
/// The same for a picture. Reads no more, and takes no more memory, than a .png or .pfm with this beginning can need; of
/// .jpg, .hdr and .exr a limited number of bytes.
/// For any other file it returns only the beginning.
glint_status glint_file_read_picture(const char *path, glint_bytes *out, glint_error *error);

// ---- leftover.c ----

#define GLINT_HOST_SIZE 48

/// This host's name, without slashes, cut to fit the buffer.
void glint_host_name(char out[GLINT_HOST_SIZE]);
/// Calls glint_drafts_collect for the folder of the file `path`, unless this process searched the folder recently. Any
/// thread.
void glint_drafts_collect_in_folder(const char *path);
/// Registers and removes the hidden name of a draft, which glint_drafts_abandon deletes in between. Any thread.
void glint_draft_enlist(const char *temporary);
void glint_draft_delist(const char *temporary);

#endif
