/// Warnings of the mesh readers, and normals of length 0.
#include "engine/base/number.h"
#include "engine/files/mesh/file.h"

#include "engine/base/vec.h"

#include <stdarg.h>
#include <stdio.h>

void glint_mesh_warn(const glint_mesh_desc *desc, const char *path, const char *format, ...)
{
    char message[512];
    if (!desc->warns)
        return;
    const int used = snprintf(message, sizeof message / 2, "%.240s: ", path);
    va_list args;
    va_start(args, format);
    glint_print_list(message + used, sizeof message - (size_t)used, format, args);
    va_end(args);
    desc->warns(desc->context, message);
}

void glint_mesh_note_that(glint_mesh_reader *reader, glint_mesh_note_kind kind, size_t line, const char *format, ...)
{
    glint_mesh_note *note = &reader->notes[kind];
    va_list args;
    if (note->count++)
        return;
    note->line = line;
    va_start(args, format);
    glint_print_list(note->first, sizeof note->first, format, args);
    va_end(args);
}

glint_status glint_mesh_drop_normals(glint_mesh_reader *r)
{
    const double up[3] = { 0, 0, 1 };
    const uint32_t *corners = r->corners.items;
    double *normals = r->normals.items;
    glint_status status = GLINT_OK;
    for (size_t i = r->corner_normals.count; i < r->corners.count && !status; i++)
        status = glint_mesh_append(&r->corner_normals, &corners[i], r->error);
    uint32_t *numbers = r->corner_normals.items;
    for (size_t i = 0; i < r->corner_normals.count && !status; i++)
        if (numbers[i] != GLINT_NO_NORMAL && vec_max_abs(normals + 3 * (size_t)numbers[i]) == 0)
            numbers[i] = GLINT_NO_NORMAL;
    for (size_t i = 0; i < r->normals.count; i++)
        if (vec_max_abs(normals + 3 * i) == 0)
            vec_copy(normals + 3 * i, up);
    return status;
}
