/// glint_mesh_load: chooses the reader of a file's format and makes the mesh from its result.
#include "engine/files/mesh/file.h"

#include "engine/base/status.h"
#include "engine/base/vec.h"
#include "engine/files/mesh/mtl.h"
#include "engine/glint_files.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static void report_notes(const glint_mesh_reader *r)
{
    for (int kind = 0; kind < GLINT_MESH_NOTE_COUNT; kind++) {
        const glint_mesh_note *note = &r->notes[kind];
        char where[256], more[32] = "";
        snprintf(where, sizeof where, note->line ? "%.220s:%zu" : "%.220s", r->text.path, note->line);
        if (note->count > 1)
            snprintf(more, sizeof more, ", and %zu more", note->count - 1);
        if (note->count)
            glint_mesh_warn(r->desc, where, "%s%s", note->first, more);
    }
}

// ---- Data that a mesh does not accept ----

static bool is_finite(const double v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/// Moves items from `from` to `to` in an array with one item per corner or face. Does nothing if the array is not
/// used.
static void move_items(glint_mesh_array *array, size_t to, size_t from, size_t count)
{
    if (from + count <= array->count)
        memmove((char *)array->items + to * array->size, (const char *)array->items + from * array->size,
                count * array->size);
}

static void cut_array(glint_mesh_array *array, size_t count)
{
    array->count = array->count < count ? array->count : count;
}

/// Leaves out faces with vertices that are not finite, and replaces such vertices by a finite one.
static void drop_vertices(glint_mesh_reader *r)
{
    double *vertices = r->vertices.items;
    const uint32_t *sizes = r->sizes.items, *corners = r->corners.items;
    size_t kept = 0, kept_corners = 0, first = 0, good = 0;
    for (size_t i = 0; i < r->sizes.count; i++) {
        const size_t size = sizes[i];
        bool whole = true;
        for (size_t k = 0; k < size; k++)
            whole = whole && is_finite(vertices + 3 * (size_t)corners[first + k]);
        if (whole) {
            move_items(&r->corners, kept_corners, first, size);
            move_items(&r->corner_normals, kept_corners, first, size);
            move_items(&r->corner_uv, kept_corners, first, size);
            move_items(&r->sizes, kept, i, 1);
            move_items(&r->material_index, kept, i, 1);
            kept_corners += size;
            kept++;
        } else {
            glint_mesh_note_that(r, GLINT_MESH_NOTE_VERTEX, 0, "face %zu is left out: one of its vertices is not "
                                                               "finite",
                                 i + 1);
        }
        first += size;
    }
    cut_array(&r->corners, kept_corners);
    cut_array(&r->corner_normals, kept_corners);
    cut_array(&r->corner_uv, kept_corners);
    cut_array(&r->sizes, kept);
    cut_array(&r->material_index, kept);
    while (good < r->vertices.count && !is_finite(vertices + 3 * good))
        good++;
    for (size_t i = 0; i < r->vertices.count && good < r->vertices.count; i++)
        if (!is_finite(vertices + 3 * i))
            vec_copy(vertices + 3 * i, vertices + 3 * good);
}

static bool has_bad_vertices(const glint_mesh_reader *r)
{
    const double *vertices = r->vertices.items;
    for (size_t i = 0; i < r->vertices.count; i++)
        if (!is_finite(vertices + 3 * i))
            return true;
    return false;
}

// ---- The file ----

static glint_status make_mesh(glint_mesh_reader *r, glint_shape **out)
{
    glint_mesh_desc mesh = *r->desc;
    mesh.struct_size = sizeof mesh;
    glint_error inner;
    glint_mesh_faults faults = { 0 };
    mesh.vertices = r->vertices.items;
    mesh.vertex_count = r->vertices.count;
    mesh.corners = r->corners.items;
    mesh.face_sizes = r->sizes.items;
    mesh.face_count = r->sizes.count;
    mesh.normals = r->has_normals ? r->normals.items : NULL;
    mesh.normal_count = r->has_normals ? r->normals.count : 0;
    mesh.normal_corners = r->has_normals && r->corner_normals.count ? r->corner_normals.items : NULL;
    mesh.uv = r->uv.count ? r->uv.items : NULL;
    mesh.uv_count = r->uv.count;
    mesh.uv_corners = r->corner_uv.count ? r->corner_uv.items : NULL;
    if (r->library)
        glint_mesh_library_give(r->library, r, &mesh);
    if (r->materials.count) {
        mesh.materials = r->materials.items;
        mesh.material_count = r->materials.count;
        mesh.material_index = r->material_index.items;
    }
    glint_status status = glint_mesh_create_counting(&mesh, &faults, out, &inner);
    if (status)
        return glint_fail(r->error, status, "%.300s: %.200s", r->text.path, inner.message);
    if (faults.flat)
        glint_mesh_warn(r->desc, r->text.path, "%zu of %zu faces are left out: they have no area", faults.flat,
                        r->sizes.count);
    if (faults.crossed)
        glint_mesh_warn(r->desc, r->text.path, "%zu of %zu faces cross themselves: they are split into fans of "
                                               "triangles",
                        faults.crossed, r->sizes.count);
    return GLINT_OK;
}

static void release(glint_mesh_reader *r)
{
    glint_mesh_array *const arrays[] = { &r->vertices,  &r->normals,          &r->uv,
                                         &r->corners,   &r->corner_normals,   &r->corner_uv,
                                         &r->sizes,     &r->material_index,   &r->colors,
                                         &r->materials, &r->numbers_of_colors, &r->groups };
    for (size_t i = 0; i < r->materials.count; i++)
        glint_material_release(((glint_material **)r->materials.items)[i]);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]->items);
    free(r->vertex_set.slots);
    glint_mesh_library_free(r->library);
    glint_mesh_text_close(&r->text);
}

// ---- Formats ----

static const char READS[] = "glint reads .obj .stl .ply";

/// Formats of other programs, by the extension of the file's name.
static const char *const ENDINGS[][2] = {
    { "glb", "glTF" },
    { "gltf", "glTF" },
    { "off", "OFF" },
    { "3mf", "3MF" },
    { "amf", "AMF" },
    { "fbx", "FBX" },
    { "dae", "COLLADA" },
    { "3ds", "3D Studio" },
    { "blend", "Blender's" },
    { "wrl", "VRML" },
    { "vrml", "VRML" },
    { "x3d", "X3D" },
    { "usd", "USD" },
    { "usda", "USD" },
    { "usdc", "USD" },
    { "usdz", "USD" },
    { "abc", "Alembic" },
    { "step", "STEP" },
    { "stp", "STEP" },
    { "iges", "IGES" },
    { "igs", "IGES" },
    { "dxf", "DXF" },
    { "vtk", "VTK" },
    { "vtp", "VTK" },
    { "vtu", "VTK" },
    { "msh", "Gmsh" },
    { "mesh", "Medit" },
    { "lwo", "LightWave" },
    { "max", "3ds Max" },
    { "c4d", "Cinema 4D" },
    { "skp", "SketchUp" },
    { "nff", "NFF (glint.nff reads it)" },
    { "cif", "CIF" },
    { "pdb", "PDB (glint.pdb reads it)" },
    { "xyz", "XYZ (glint.xyz reads it)" },
    { "gz", "compressed" },
    { "zip", "compressed" },
    { "xz", "compressed" },
    { "bz2", "compressed" },
    { "zst", "compressed" },
    { "mtl", "materials of an .obj" },
};

/// Formats by the first bytes of the file, whatever its name.
static const char *const BEGINNINGS[][2] = {
    { "glTF", "glTF" },          { "PK\3\4", "a zip archive, as .3mf and .usdz are" },
    { "Kaydara FBX", "FBX" },    { "BLENDER", "Blender's" },
    { "#VRML", "VRML" },         { "\x1f\x8b", "compressed" },
    { "OFF\n", "OFF" },          { "OFF\r", "OFF" },
    { "# vtk DataFile", "VTK" }, { "<?xml", "XML" },
    { "ISO-10303-21", "STEP" },  { "PXR-USDC", "USD" },
    { "#usda", "USD" },
};

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot + 1 : "";
}

static glint_status refuse_foreign(const glint_mesh_reader *r)
{
    const char *kind = NULL, *ending = ending_of(r->text.path);
    for (size_t i = 0; i < sizeof ENDINGS / sizeof *ENDINGS; i++)
        if (strcasecmp(ending, ENDINGS[i][0]) == 0)
            kind = ENDINGS[i][1];
    for (size_t i = 0; i < sizeof BEGINNINGS / sizeof *BEGINNINGS; i++) {
        const size_t length = strlen(BEGINNINGS[i][0]);
        if (r->text.begin_bytes >= length && memcmp(r->text.begin, BEGINNINGS[i][0], length) == 0)
            kind = BEGINNINGS[i][1];
    }
    if (glint_mesh_text_is_utf16(&r->text))
        kind = "UTF-16, not UTF-8";
    return kind ? glint_fail(r->error, GLINT_ERR_FORMAT, "%s: is %s; %s", r->text.path, kind, READS) : GLINT_OK;
}

typedef glint_status (*reading)(glint_mesh_reader *reader);

static bool begins(const glint_mesh_text *text, const char *word)
{
    const size_t length = strlen(word), from = (size_t)text->start;
    return text->begin_bytes > from + length && memcmp(text->begin + from, word, length) == 0 &&
           text->begin[from + length] <= ' ';
}

/// Chooses the reader by the first bytes if they identify the format, otherwise by the extension of its name.
static reading reader_of(const glint_mesh_text *text)
{
    const char *ending = ending_of(text->path);
    const bool is_obj = strcasecmp(ending, "obj") == 0;
    if (begins(text, "ply") || strcasecmp(ending, "ply") == 0)
        return glint_mesh_read_ply;
    return strcasecmp(ending, "stl") == 0 || (!is_obj && begins(text, "solid")) ? glint_mesh_read_stl
                                                                                : glint_mesh_read_obj;
}

glint_status glint_mesh_load(const char *path, const glint_mesh_desc *given, glint_shape **out, glint_error *error)
{
    GLINT_REFUSE_NULL(path, error);
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_mesh_desc, glint_mesh_desc_default());
    glint_mesh_reader r = { .desc = desc, .error = error };
    r.vertices.size = r.normals.size = r.numbers_of_colors.size = 3 * sizeof(double);
    r.uv.size = 2 * sizeof(double);
    r.colors.size = 3;
    r.materials.size = sizeof(glint_material *);
    r.corners.size = r.corner_normals.size = r.corner_uv.size = r.sizes.size = r.material_index.size = r.groups.size =
        sizeof(uint32_t);
    if (desc->reads)
        desc->reads(desc->context, path);
    status = glint_mesh_text_open(&r.text, path, error);
    if (!status)
        status = refuse_foreign(&r);
    if (!status)
        status = reader_of(&r.text)(&r);
    if (!status && has_bad_vertices(&r))
        drop_vertices(&r);
    if (!status && r.sizes.count == 0)
        status = glint_fail(error, GLINT_ERR_FORMAT,
                            "%s: faces expected, got only faces with a vertex that is not finite", path);
    if (!status)
        status = make_mesh(&r, out);
    if (!status)
        report_notes(&r);
    release(&r);
    return status;
}
