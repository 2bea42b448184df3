/// The fields of overlays: those that all or several kinds have, and the tables of each kind. Private to bindings/lua.
///
///     overlay.c    the class; labels, arrows, lines and arcs; the shared fields
///     axes.c       colour bars and axes
///     curve.c      polylines, and the curves that are computed before each frame: lobes, paths, frustums
///     chart.c      charts
#ifndef GLINT_L_OVERLAY_H
#define GLINT_L_OVERLAY_H

#include "bindings/lua/lua.h"
#include "engine/glint_figures.h"
#include "engine/glint_inspect.h"

#include <stddef.h>

typedef glint_overlay_desc desc_type;

#define AT(member) offsetof(desc_type, member)

/// Reads {a, b}. expected: the text of the error.
void glintL_overlay_read_pair(lua_State *L, int index, const char *path, const char *expected, double out[2]);
void glintL_overlay_push_pair(lua_State *L, const double pair[2], const char *name);
/// Copies a string without zero bytes; the rest of `out` becomes zero.
void glintL_overlay_copy_text(lua_State *L, int index, const char *path, char *out, size_t capacity);
/// Reads "linear" or "log" for the field `name`; returns whether it is "log".
bool glintL_overlay_read_log(lua_State *L, int index, const char *object, const char *name);
extern const char *const glintL_overlay_scales[], *const glintL_overlay_hidden[];

// Readers and writers of single fields.
void glintL_overlay_read_at(lua_State *L, int index, const char *path, void *desc);
void glintL_overlay_push_at(lua_State *L, const void *desc);
void glintL_overlay_read_position(lua_State *L, int index, const char *path, void *desc);
void glintL_overlay_push_position(lua_State *L, const void *desc);
void glintL_overlay_read_text(lua_State *L, int index, const char *path, void *desc);
void glintL_overlay_push_text(lua_State *L, const void *desc);

#define EVERY_OVERLAY \
    {.name = "at", GLINTL_CUSTOM(glintL_overlay_read_at, glintL_overlay_push_at)}, \
    {.name = "position", GLINTL_CUSTOM(glintL_overlay_read_position, glintL_overlay_push_position), .set_offset = AT(has_position)}, \
    LOOKS

#define LOOKS \
    {.name = "size", .type = GLINT_TYPE_NUMBER, .offset = AT(size), .set_offset = AT(has_size)}, \
    {.name = "margin", .type = GLINT_TYPE_NUMBER, .offset = AT(margin), .set_offset = AT(has_margin)}, \
    {.name = "color", .type = GLINT_TYPE_COLOR, .offset = AT(color)}, \
    {.name = "background", .type = GLINT_TYPE_COLOR, .offset = AT(background), .set_offset = AT(has_background)}, \
    {.name = "opacity", .type = GLINT_TYPE_NUMBER, .offset = AT(opacity)}, \
    {.name = "name", .type = GLINT_TYPE_TEXT, .offset = AT(name)}

#define CURVE \
    {.name = "label", GLINTL_CUSTOM(glintL_overlay_read_text, glintL_overlay_push_text)}, \
    {.name = "width", .type = GLINT_TYPE_NUMBER, .offset = AT(width), .set_offset = AT(has_width)}, \
    HIDES

#define HIDES {.name = "hidden", .type = GLINT_TYPE_CHOICE, .offset = AT(hidden), .names = glintL_overlay_hidden}

#define LENGTH {.name = "length", .type = GLINT_TYPE_NUMBER, .offset = AT(length), .set_offset = AT(has_length)}

extern const glintL_field glintL_colorbar_fields[], glintL_axes_fields[], glintL_polyline_fields[], glintL_lobe_fields[],
    glintL_path_fields[], glintL_frustum_fields[], glintL_chart_fields[];
extern const luaL_Reg glintL_curve_getters[], glintL_chart_methods[];

/// Hooks of the class: store the objects that an overlay is computed from, its material, scene and camera.
void glintL_curve_accepted(lua_State *L, const glintL_field *field, const void *desc);
void glintL_curve_made(lua_State *L, const void *desc);

#endif
