/// Makes the materials that the faces of .obj files use, from the entries that glint_mesh_library_read stored.
#include "engine/files/mesh/entry.h"
#include "engine/glint_files.h"

#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/base/vec.h"

#include <stdlib.h>
#include <string.h>

#define ILLUM_DEFAULT 2 ///< illum without a statement: a highlight, but no mirror
#define ROUGHNESS_DEFAULT 0.5
#define F0_OF_PLASTIC 0.04 ///< reflectance at normal incidence for an index of 1.5

glint_mesh_library *glint_mesh_library_create(void)
{
    glint_mesh_library *library = calloc(1, sizeof *library);
    if (!library)
        return NULL;
    library->known.size = library->used.size = sizeof(glint_mesh_entry);
    library->pictures.size = sizeof(glint_mesh_picture);
    library->materials.size = sizeof(glint_material *);
    library->current.desc = glint_material_desc_default();
    library->current.illum = ILLUM_DEFAULT;
    library->current.rough = library->current.metal = -1;
    library->current_number = GLINT_MESH_NO_FACE;
    return library;
}

static void free_maps(glint_mesh_entry *e)
{
    for (int kind = 0; kind < GLINT_MAP_COUNT; kind++)
        free(e->map[kind]);
}

void glint_mesh_library_free(glint_mesh_library *library)
{
    if (!library)
        return;
    for (size_t i = 0; i < library->known.count; i++)
        free_maps(glint_mesh_known_at(library, i));
    for (size_t i = 0; i < library->materials.count; i++)
        glint_material_release(((glint_material **)library->materials.items)[i]);
    for (size_t i = 0; i < library->pictures.count; i++)
        glint_texture_release(((glint_mesh_picture *)library->pictures.items)[i].texture);
    free(library->known.items);
    free(library->used.items);
    free(library->pictures.items);
    free(library->materials.items);
    free(library->known_set.slots);
    free(library->used_set.slots);
    free(library->picture_set.slots);
    free(library->file);
    free(library);
}

glint_key glint_mesh_key_of(const char *name) { return glint_key_add_string((glint_key) { 0, 1 }, name); }

void glint_mesh_copy_name(char out[GLINT_NAME_SIZE], const char *name)
{
    size_t length = strlen(name);
    if (length >= GLINT_NAME_SIZE)
        for (length = GLINT_NAME_SIZE - 1; length > 0 && ((unsigned char)name[length] & 0xc0) == 0x80; length--)
            ;
    memcpy(out, name, length);
    out[length] = 0;
}

void glint_mesh_library_use(glint_mesh_library *library, const char *name)
{
    library->current.key = glint_mesh_key_of(name);
    glint_mesh_copy_name(library->current.desc.name, name);
    library->current_number = GLINT_MESH_NO_FACE;
}

glint_status glint_mesh_library_face(glint_mesh_library *library, uint32_t *number, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (library->current_number == GLINT_MESH_NO_FACE)
        status = glint_mesh_find(&library->used_set, &library->used, &library->current, sizeof(glint_key),
                                 &library->current_number, error);
    *number = library->current_number;
    return status;
}

glint_status glint_mesh_library_begin(glint_mesh_library *library, const char *name, uint32_t *number,
                                      glint_error *error)
{
    glint_mesh_entry made = { .key = glint_mesh_key_of(name),
                              .desc = glint_material_desc_default(),
                              .illum = ILLUM_DEFAULT,
                              .rough = -1,
                              .metal = -1 };
    for (int kind = 0; kind < GLINT_MAP_COUNT; kind++)
        made.mapping[kind].scale[0] = made.mapping[kind].scale[1] = 1;
    glint_mesh_copy_name(made.desc.name, name);
    glint_status status =
        glint_mesh_find(&library->known_set, &library->known, &made, sizeof(glint_key), number, error);
    if (status)
        return status;
    free_maps(glint_mesh_known_at(library, *number));
    *glint_mesh_known_at(library, *number) = made;
    return GLINT_OK;
}

// ---- Pictures ----

/// For messages: what replaces each kind of picture if it cannot be read.
static const char *const map_instead[GLINT_MAP_COUNT] = { "its Kd", "its Ks", "its d", "no relief" };

/// Writes the picture of a material to *out; NULL, after a warning: it cannot be read.
static glint_status find_picture(glint_mesh_library *library, const glint_mesh_reader *reader,
                                 const glint_mesh_entry *e, glint_mesh_map_kind kind, glint_texture **out)
{
    const bool how[2] = { e->mapping[kind].clamp, kind >= GLINT_MAP_D };
    uint32_t number;
    glint_texture_desc desc = glint_texture_desc_default();
    glint_error inner;
    const size_t before = library->pictures.count;
    const glint_mesh_picture wanted = { .key = glint_key_add(glint_mesh_key_of(e->map[kind]), how, sizeof how) };
    glint_status status =
        glint_mesh_find(&library->picture_set, &library->pictures, &wanted, sizeof(glint_key), &number, reader->error);
    *out = NULL;
    if (status)
        return status;
    glint_mesh_picture *found = (glint_mesh_picture *)library->pictures.items + number;
    if (library->pictures.count > before) {
        desc.linear = kind >= GLINT_MAP_D; // these maps hold numbers, not colours
        desc.wrap = e->mapping[kind].clamp ? GLINT_WRAP_CLAMP : GLINT_WRAP_REPEAT;
        if (reader->desc->reads)
            reader->desc->reads(reader->desc->context, e->map[kind]);
        status = glint_texture_read(e->map[kind], &desc, &found->texture, &inner);
        if (status == GLINT_ERR_NOMEM)
            return glint_fail_nomem(reader->error);
        if (status)
            glint_mesh_warn(reader->desc, reader->text.path, "material '%s' has %s instead of its %s: %.200s",
                            e->desc.name, map_instead[kind], glint_mesh_map_words[kind], inner.message);
    }
    *out = found->texture;
    return GLINT_OK;
}

// ---- Materials ----

/// Sets up microfacets with the roughness Pr and the metallic share Pm.
static void roughen(glint_mesh_entry *e)
{
    const double metal = e->metal < 0 ? 0 : e->metal;
    e->desc.model = GLINT_MODEL_COOK_TORRANCE;
    e->desc.roughness = e->rough < 0 ? ROUGHNESS_DEFAULT : e->rough;
    e->desc.has_f0 = true;
    e->desc.has_specular = false;
    for (int c = 0; c < 3; c++) {
        e->desc.f0[c] = (1 - metal) * F0_OF_PLASTIC + metal * fmin(e->desc.diffuse[c], 1);
        e->desc.diffuse[c] *= 1 - metal;
    }
}

/// Sets up mirror and refraction as illum requires.
static void polish(glint_mesh_entry *e)
{
    const bool bends = (e->illum == 6 || e->illum == 7) && e->clear > 0;
    e->desc.ior = e->clear == 0 || bends ? (e->ni > 0 ? e->ni : e->desc.ior) : 1;
    e->desc.fresnel = (e->illum == 5 || e->illum == 7) && (e->clear == 0 || bends);
    if (e->illum < 3 || e->illum > 7 || !e->desc.has_specular || e->rough >= 0 || e->metal >= 0)
        return;
    e->desc.has_mirror = true;
    vec_copy(e->desc.mirror, e->desc.specular);
}

/// Notes a colour above 1, which is probably a colour of bytes.
static void note_bright(glint_mesh_library *library, const glint_mesh_entry *e, const char *word, const double c[3])
{
    if (fmax(fmax(c[0], c[1]), c[2]) > 1 && library->bright++ == 0)
        glint_print(library->first_bright, sizeof library->first_bright, "'%s' has %s %g %g %g", e->desc.name, word, c[0], c[1], c[2]);
}

/// Completes the fields of a material. If it is transparent, the surface's own light is multiplied by d.
static void finish_fields(glint_mesh_library *library, glint_mesh_entry *e)
{
    const bool is_dull = e->illum < 2;
    note_bright(library, e, "Kd", e->desc.diffuse);
    note_bright(library, e, "Ks", e->desc.specular);
    if (e->clear >= 1 && !e->map[GLINT_MAP_D] && library->invisible++ == 0)
        memcpy(library->first_invisible, e->desc.name, sizeof library->first_invisible);
    polish(e);
    if (e->rough >= 0 || e->metal >= 0)
        roughen(e);
    for (int c = 0; c < 3; c++) {
        e->desc.specular[c] *= is_dull ? 0 : 1 - e->clear;
        e->desc.diffuse[c] *= 1 - e->clear;
        e->desc.transmission[c] = e->clear;
    }
}

/// Returns whether the bump map of a material has a height. Counts the materials whose bump map has no height.
static bool has_height(glint_mesh_library *library, const glint_mesh_entry *e)
{
    if (e->height == 0 && library->flat++ == 0)
        library->first_flat = *e;
    return e->height != 0;
}

/// Makes the pattern of one of the pictures, multiplied by the factor in the file.
static glint_status paint(glint_mesh_library *library, const glint_mesh_reader *reader, const glint_mesh_entry *e,
                          glint_mesh_map_kind kind, glint_program **out)
{
    static const double one[3] = { 1, 1, 1 };
    const double *const ks = e->desc.has_specular || e->illum < 2 ? e->desc.specular : one;
    const double height[3] = { e->height };
    const double *const factor[GLINT_MAP_COUNT] = { e->desc.diffuse, ks, one, height };
    glint_texture *texture = NULL;
    glint_status status = GLINT_OK;
    if (!e->map[kind] || (kind == GLINT_MAP_BUMP && !has_height(library, e)))
        return GLINT_OK;
    if (e->lacks_uv)
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s' has %s instead of its %s: some of its faces have no texture coordinates (vt)", e->desc.name,
                        map_instead[kind], glint_mesh_map_words[kind]);
    else
        status = find_picture(library, reader, e, kind, &texture);
    bool grey = true;
    if (!status && texture && kind == GLINT_MAP_BUMP)
        status = glint_mesh_find_grey(texture, &grey, reader->error);
    if (!status && !grey) {
        glint_mesh_warn(
            reader->desc, reader->text.path,
            "material '%s' has no relief instead of its map_Bump: heights in grey expected, got a picture with "
            "colours, such as a normal map",
            e->desc.name);
        return status;
    }
    if (!status && texture)
        status =
            glint_mesh_paint(texture, &e->mapping[kind], factor[kind], kind >= GLINT_MAP_D ? 1 : 3, out, reader->error);
    return status;
}

static glint_status make_material(glint_mesh_library *library, const glint_mesh_reader *reader, uint32_t number)
{
    glint_mesh_entry e = *glint_mesh_used_at(library, number);
    glint_material *material;
    glint_program *made[GLINT_MAP_COUNT] = { NULL };
    glint_status status = GLINT_OK;
    finish_fields(library, &e);
    for (int kind = 0; kind < GLINT_MAP_COUNT && !status; kind++)
        status = paint(library, reader, &e, (glint_mesh_map_kind)kind, &made[kind]);
    e.desc.program.diffuse = made[GLINT_MAP_KD];
    e.desc.program.specular = made[GLINT_MAP_KS];
    e.desc.program.opacity = made[GLINT_MAP_D];
    e.desc.program.bump = made[GLINT_MAP_BUMP];
    e.desc.has_specular = e.desc.has_specular || made[GLINT_MAP_KS];
    if (!status)
        status = glint_material_create(&e.desc, &material, reader->error);
    for (int kind = 0; kind < GLINT_MAP_COUNT; kind++)
        glint_program_release(made[kind]);
    if (status)
        return status;
    status = glint_mesh_append(&library->materials, &material, reader->error);
    if (status)
        glint_material_release(material);
    return status;
}

/// Determines which materials have faces without texture coordinates.
static void find_uv(glint_mesh_library *library, const glint_mesh_reader *reader)
{
    const uint32_t *sizes = reader->sizes.items, *index = reader->material_index.items, *uv = reader->corner_uv.items;
    for (size_t i = 0, corner = 0; i < reader->sizes.count; corner += sizes[i++])
        for (uint32_t j = 0; j < sizes[i]; j++)
            if (!reader->corner_uv.count || uv[corner + j] == GLINT_NO_UV)
                glint_mesh_used_at(library, index[i])->lacks_uv = true;
}

/// Finds the entry of a used material. Faces without a usemtl, or with an undefined one, get a material with default
/// fields.
static glint_status look_up(glint_mesh_library *library, const glint_mesh_reader *reader, glint_mesh_entry *used)
{
    static const glint_key none;
    uint32_t number;
    const size_t before = library->known.count;
    if (glint_key_equal(used->key, none))
        return GLINT_OK;
    glint_status status =
        glint_mesh_find(&library->known_set, &library->known, used, sizeof(glint_key), &number, reader->error);
    if (status)
        return status;
    if (library->known.count == before) {
        const bool lacks_uv = used->lacks_uv;
        *used = *glint_mesh_known_at(library, number);
        library->is_used = true;
        used->lacks_uv = lacks_uv;
    } else if (library->missing++ == 0) {
        memcpy(library->first_missing, used->desc.name, sizeof library->first_missing);
    }
    return GLINT_OK;
}

/// Writes " and N more", with N = `count` - 1; "" if N is 0.
static const char *spell_more(size_t count, char out[32])
{
    out[0] = 0;
    if (count > 1)
        snprintf(out, 32, " and %zu more", count - 1);
    return out;
}

/// Warns once about bump maps without a height.
static void warn_flat(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    const glint_mesh_entry *e = &library->first_flat;
    if (!library->flat)
        return;
    spell_more(library->flat, more);
    if (e->bm[0])
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s'%s: no relief: -bm of map_Bump: a height in world units other than 0 expected, "
                        "got '%s'",
                        e->desc.name, more, e->bm);
    else
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s'%s: no relief: map_Bump has no -bm, which gives its height in world units",
                        e->desc.name, more);
}

static void warn_invisible(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    if (library->invisible)
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s'%s cannot be seen: d 0, or Tr 1, lets all light through",
                        library->first_invisible, spell_more(library->invisible, more));
}

static void warn_bright(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    if (library->bright)
        glint_mesh_warn(reader->desc, reader->text.path, "material %s%s: numbers 0 .. 1 expected; divide a colour of bytes by 255",
                        library->first_bright, spell_more(library->bright, more));
}

/// Warns once about undefined materials, unless a file that could not be read explains them.
static void warn_missing(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    if (library->missing && !library->reported)
        glint_mesh_warn(reader->desc, reader->text.path, "material '%s'%s: %s%.200s", library->first_missing,
                        spell_more(library->missing, more),
                        library->file ? "not in " : "the mesh names no material file (mtllib)",
                        library->file ? library->file : "");
}

glint_status glint_mesh_library_make(glint_mesh_library *library, const glint_mesh_reader *reader)
{
    glint_status status = GLINT_OK;
    find_uv(library, reader);
    for (uint32_t i = 0; i < library->used.count && !status; i++) {
        status = look_up(library, reader, glint_mesh_used_at(library, i));
        if (!status)
            status = make_material(library, reader, i);
    }
    if (!status) {
        warn_missing(library, reader);
        warn_flat(library, reader);
        warn_invisible(library, reader);
        warn_bright(library, reader);
    }
    return status;
}

bool glint_mesh_library_is_used(const glint_mesh_library *library) { return library->is_used; }

void glint_mesh_library_give(const glint_mesh_library *library, const glint_mesh_reader *reader, glint_mesh_desc *desc)
{
    desc->materials = library->materials.items;
    desc->material_count = library->materials.count;
    desc->material_index = reader->material_index.items;
}
