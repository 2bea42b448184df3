// Poses: a camera's position and axes as a matrix, which maps a point of the world to x right, y down, z away from the
// eye.
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "bindings/value/glintL.h"

#define SQUARE 1e-3 // largest deviation of a matrix from a rotation: enough for numbers with four digits

static double dot(const double a[3], const double b[3]) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

// Reads the row of four numbers on top, and pops it.
static void take_row(lua_State *L, const char *path, double rotation[3], double *shift)
{
    char element[96];
    if (!lua_istable(L, -1) || lua_rawlen(L, -1) != 4)
        glintL_refuse(L, -1, path, "row of four numbers");
    for (int k = 0; k < 4; k++) {
        snprintf(element, sizeof element, "%.80s[%d]", path, k + 1);
        lua_rawgeti(L, -1, k + 1);
        *(k < 3 ? &rotation[k] : shift) = glintL_read_number(L, -1, element);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

static void check_rotation(lua_State *L, const char *path, double row[3][3])
{
    double third[3];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k <= i; k++)
            if (!(fabs(dot(row[i], row[k]) - (i == k)) < SQUARE))
                glintL_error(L, "%s: a rotation expected, whose rows have length 1 and are perpendicular, got %f for "
                                "the product of row %d and row %d", path,
                             dot(row[i], row[k]), i + 1, k + 1);
    cross(row[0], row[1], third);
    if (dot(third, row[2]) < 0)
        glintL_error(L, "%s: a rotation expected, got one that also mirrors; its rows are x to the right, y down, z "
                        "away from the eye", path);
}

// The fields that a pose replaces, in the order of the rows that GLINT_TYPE_POSE requires.
enum { EYE, AT, DIRECTION, UP };

static double *part(const glintL_field *parts, int i, const void *desc)
{
    return (double *)(void *)((char *)(uintptr_t)desc + parts[i].offset);
}

void glintL_read_pose(lua_State *L, int index, const char *path, const glintL_field *parts, void *desc)
{
    double *eye = part(parts, EYE, desc), *direction = part(parts, DIRECTION, desc), *up = part(parts, UP, desc);
    double row[4][3], shift[4] = { 0, 0, 0, 1 };
    char element[96];
    index = lua_absindex(L, index);
    luaL_checkstack(L, 6, "matrix");
    const size_t rows = lua_istable(L, index) ? lua_rawlen(L, index) : 0;
    if (rows != 3 && rows != 4)
        glintL_refuse(L, index, path, "3 or 4 rows of four numbers");
    for (size_t i = 0; i < rows; i++) {
        snprintf(element, sizeof element, "%.50s[%zu]", path, i + 1);
        lua_rawgeti(L, index, (lua_Integer)i + 1);
        take_row(L, element, row[i], &shift[i]);
    }
    if (rows == 4 && !(row[3][0] == 0 && row[3][1] == 0 && row[3][2] == 0 && shift[3] == 1))
        glintL_error(L, "%s[4]: { 0, 0, 0, 1 } expected", path);
    check_rotation(L, path, row);
    for (int c = 0; c < 3; c++) {
        eye[c] = -((row[0][c] * shift[0] + row[1][c] * shift[1]) + row[2][c] * shift[2]);
        direction[c] = row[2][c];
        up[c] = -row[1][c];
    }
    ((bool *)desc)[parts[DIRECTION].set_offset] = true;
}

static void normalize(double v[3])
{
    const double length = sqrt(dot(v, v));
    for (int c = 0; c < 3; c++)
        v[c] /= length;
}

// Pushes nil if the view is along `up`, since the engine then chooses its sides.
void glintL_push_pose(lua_State *L, const glintL_field *parts, const void *desc)
{
    const double *eye = part(parts, EYE, desc), *at = part(parts, AT, desc), *direction = part(parts, DIRECTION, desc),
                 *up = part(parts, UP, desc);
    const bool has_direction = ((const bool *)desc)[parts[DIRECTION].set_offset];
    double row[3][3];
    for (int c = 0; c < 3; c++)
        row[2][c] = has_direction ? direction[c] : at[c] - eye[c];
    normalize(row[2]);
    cross(row[2], up, row[0]);
    if (!(dot(row[0], row[0]) > 1e-24 * dot(up, up))) {
        lua_pushnil(L);
        return;
    }
    normalize(row[0]);
    cross(row[2], row[0], row[1]);
    lua_createtable(L, 3, 0);
    for (int i = 0; i < 3; i++) {
        lua_createtable(L, 4, 0);
        for (int c = 0; c < 3; c++) {
            lua_pushnumber(L, row[i][c]);
            lua_rawseti(L, -2, c + 1);
        }
        lua_pushnumber(L, -dot(row[i], eye));
        lua_rawseti(L, -2, 4);
        lua_rawseti(L, -2, i + 1);
    }
}
