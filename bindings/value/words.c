// Misspelt words: finds the nearest known word, or the equivalent of a name from other programs.
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "bindings/value/glintL.h"

#define WORD_MAX 32 // longer names match nothing

static int least(int a, int b) { return a < b ? a : b; }

// Returns the number of edits that turn one word into the other: a letter added, removed or changed, or two neighbours
// swapped.
static int distance(const char *a, const char *b)
{
    int rows[3][WORD_MAX + 1], *before = rows[0], *above = rows[1], *row = rows[2];
    int na = (int)strlen(a), nb = (int)strlen(b);
    for (int j = 0; j <= nb; j++)
        above[j] = j;
    for (int i = 1; i <= na; i++) {
        row[0] = i;
        for (int j = 1; j <= nb; j++) {
            int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
            row[j] = least(least(above[j], row[j - 1]) + 1, above[j - 1] + (ca != cb));
            if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) && cb == tolower((unsigned char)a[i - 2]))
                row[j] = least(row[j], before[j - 2] + 1);
        }
        int *spare = before;
        before = above;
        above = row;
        row = spare;
    }
    return above[nb];
}

// Returns the distance of a known name from the misspelt one; WORD_MAX if it is not near.
static int farness(const char *name, const char *known)
{
    size_t length = strlen(name);
    if (length > WORD_MAX || strlen(known) > WORD_MAX)
        return WORD_MAX;
    int edits = distance(name, known);
    if (edits <= (length < 5 ? 1 : (int)length / 3))
        return edits;
    if (length >= 3 && strncmp(name, known, length) == 0) // a beginning of the known name
        return WORD_MAX - 1;
    return WORD_MAX;
}

const char *glintL_nearer(const char *name, const char *best, const char *candidate)
{
    int limit = best ? farness(name, best) : WORD_MAX;
    return farness(name, candidate) < limit ? candidate : best;
}

// Names in other programs, and their equivalents here. Several rows may have the same name: the first equivalent that
// the object has applies.
static const char *const MEANINGS[][2] = {
    { "falloff", "attenuation" },
    { "color", "diffuse" },
    { "colour", "diffuse" },
    { "kd", "diffuse" },
    { "ks", "specular" },
    { "ka", "ambient" },
    { "exponent", "shininess" },
    { "gloss", "shininess" },
    { "glossiness", "shininess" },
    { "reflection", "mirror" },
    { "reflectivity", "mirror" },
    { "refraction", "transmission" },
    { "transparency", "transmission" },
    { "index", "ior" },
    { "texture", "diffuse" },
    { "color", "material" },
    { "colour", "material" },
    { "diffuse", "material" },
    { "brightness", "intensity" },
    { "power", "intensity" },
    { "size", "radius" },
    { "pos", "position" },
    { "position", "center" },
    { "pos", "center" },
    { "origin", "center" },
    { "location", "position" },
    { "location", "center" },
    { "position", "eye" },
    { "pos", "eye" },
    { "location", "eye" },
    { "origin", "eye" },
    { "from", "eye" },
    { "target", "at" },
    { "look_at", "at" },
    { "lookat", "at" },
    { "to", "at" },
    { "angle", "fov" },
    { "zoom", "fov" },
    { "lens", "aperture" },
    { "lens_radius", "aperture" },
    { "aperture_radius", "aperture" },
    { "focal_point", "focus" },
    { "focal_distance", "focus" },
    { "focus_distance", "focus" },
    { "sides", "blades" },
    { "points", "vertices" },
    { "triangles", "faces" },
    { "indices", "faces" },
    { "path", "file" },
    { "cube", "box" },
    { "ball", "sphere" },
    { "tube", "cylinder" },
    { "ring", "torus" },
    { "donut", "torus" },
    { "triangle", "mesh" },
    { "triangles", "mesh" },
    { "polygon", "mesh" },
    { "model", "mesh" },
    { "light", "point_light" },
    { "sun", "directional_light" },
    { "lamp", "point_light" },
    { "area_light", "polygon_light" },
    { "node", "group" },
    { "merge", "union" },
    { "csg", "difference" },
    { "subtract", "difference" },
    { "intersect", "intersection" },
    { "vec3", "vector" },
    { "vec", "vector" },
    { "lerp", "mix" },
};

const char *glintL_meaning(const char *name, bool (*has)(const void *context, const char *known), const void *context)
{
    for (size_t i = 0; i < sizeof MEANINGS / sizeof *MEANINGS; i++)
        if (strcasecmp(MEANINGS[i][0], name) == 0 && has(context, MEANINGS[i][1]))
            return MEANINGS[i][1];
    return NULL;
}
