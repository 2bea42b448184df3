/// Materials of .obj files: Kd, Ks, Ns, d, map_Kd, map_Ks, map_d and map_Bump of the .mtl files that they name.
#include "engine/scene/mesh_mtl.h"

#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>

#define NO_FACE 0xffffffffu

/// Pictures that a material may have.
typedef enum map_kind { MAP_KD, MAP_KS, MAP_D, MAP_BUMP, MAP_COUNT } map_kind;

/// A material as a file has it. Sets find these by their key.
typedef struct entry {
    glint_key key; ///< of its name; 0: the faces before the first usemtl
    glint_material_desc desc;
    double clear; ///< what it lets through: 1 - d
    bool dull; ///< illum 0 or 1: without a highlight
    bool lacks_uv; ///< a face has it and a corner without coordinates
    char *map[MAP_COUNT]; ///< NULL: none
    glint_mesh_map place[MAP_COUNT]; ///< of each
    double height; ///< -bm of the relief, world units; 0: none that can be taken
    char bm[GLINT_NAME_SIZE]; ///< what the file says for it; "": nothing
    bool bm_last; ///< it stands after the picture's name
} entry;

typedef struct picture {
    glint_key key; ///< of its path, of `clamp`, and of whether its codes are numbers as they are
    glint_texture *texture; ///< NULL: it cannot be read
} picture;

struct glint_mesh_library {
    glint_mesh_array known, used, pictures; ///< of the files; of the faces; of both
    glint_mesh_set known_set, used_set, picture_set;
    glint_mesh_array materials; ///< glint_material *, one for each of `used`
    entry current; ///< of faces that follow: its key and name
    uint32_t current_number; ///< among `used`; NO_FACE: no face has it yet
    char *file; ///< the first that was named; NULL: none
    size_t missing; ///< materials of faces that no file has
    char first_missing[GLINT_NAME_SIZE];
    size_t flat; ///< materials whose relief has no height
    entry first_flat; ///< its pictures are another's
    bool told; ///< a file could not be read, which was a warning
};

glint_mesh_library *glint_mesh_library_create(void)
{
    glint_mesh_library *library = calloc(1, sizeof *library);
    if (!library)
        return NULL;
    library->known.size = library->used.size = sizeof(entry);
    library->pictures.size = sizeof(picture);
    library->materials.size = sizeof(glint_material *);
    library->current.desc = glint_material_desc_default();
    library->current_number = NO_FACE;
    return library;
}

static entry *known_at(const glint_mesh_library *library, size_t i) { return (entry *)library->known.items + i; }
static entry *used_at(const glint_mesh_library *library, size_t i) { return (entry *)library->used.items + i; }

static void free_maps(entry *e)
{
    for (int kind = 0; kind < MAP_COUNT; kind++)
        free(e->map[kind]);
}

void glint_mesh_library_free(glint_mesh_library *library)
{
    if (!library)
        return;
    for (size_t i = 0; i < library->known.count; i++)
        free_maps(known_at(library, i));
    for (size_t i = 0; i < library->materials.count; i++)
        glint_material_release(((glint_material **)library->materials.items)[i]);
    for (size_t i = 0; i < library->pictures.count; i++)
        glint_texture_release(((picture *)library->pictures.items)[i].texture);
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

static glint_key key_of(const char *name) { return glint_key_add_string((glint_key) { 0, 1 }, name); }

/// As much of a name as an object's has room for, without half a character at its end.
static void copy_name(char out[GLINT_NAME_SIZE], const char *name)
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
    library->current.key = key_of(name);
    copy_name(library->current.desc.name, name);
    library->current_number = NO_FACE;
}

glint_status glint_mesh_library_face(glint_mesh_library *library, uint32_t *number, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (library->current_number == NO_FACE)
        status = glint_mesh_find(&library->used_set, &library->used, &library->current, sizeof(glint_key),
                                 &library->current_number, error);
    *number = library->current_number;
    return status;
}

// ---- The statements of a file ----

/// One number stands for three.
static glint_status read_color(const glint_mesh_text *text, const char *at, double out[3])
{
    if (glint_mesh_is_word(glint_skip_blanks(at), "spectral") || glint_mesh_is_word(glint_skip_blanks(at), "xyz"))
        return glint_mesh_refuse(text, "red, green and blue", glint_skip_blanks(at));
    for (int c = 0; c < 3; c++) {
        if (c > 0 && !*glint_skip_blanks(at)) {
            out[c] = out[c - 1];
            continue;
        }
        glint_status status = glint_mesh_number(text, &at, &out[c]);
        if (status)
            return status;
        if (out[c] < 0)
            return glint_mesh_refuse(text, "numbers >= 0", at);
    }
    return GLINT_OK;
}

static glint_status read_range(const glint_mesh_text *text, const char *at, double most, double *out)
{
    double number;
    char expected[48];
    at = glint_skip_blanks(at);
    const char *start = at;
    if (glint_mesh_is_word(at, "-halo"))
        at += sizeof "-halo" - 1;
    glint_status status = glint_mesh_number(text, &at, &number);
    if (status)
        return status;
    snprintf(expected, sizeof expected, most < 1e300 ? "a number 0 .. %g" : "a number >= 0", most);
    if (!(number >= 0 && number <= most))
        return glint_mesh_refuse(text, expected, start);
    *out = number;
    return GLINT_OK;
}

/// The words of an option of a map; 0: it is none.
static int option_words(const char *at)
{
    static const struct {
        const char *name;
        int words;
    } options[] = { { "-blendu", 1 }, { "-blendv", 1 },  { "-boost", 1 }, { "-bm", 1 }, { "-cc", 1 },
                    { "-clamp", 1 },  { "-imfchan", 1 }, { "-mm", 2 },    { "-o", 3 },  { "-s", 3 },
                    { "-t", 3 },      { "-texres", 1 },  { "-type", 1 } };
    for (size_t i = 0; i < sizeof options / sizeof *options; i++)
        if (glint_mesh_is_word(at, options[i].name))
            return options[i].words;
    return 0;
}

/// Numbers of -o and -s, of which those after the first may be missing.
static const char *skip_option(const glint_mesh_text *text, const char *at, int words, double *numbers)
{
    while (!glint_ends_word(*at))
        at++;
    for (int i = 0; i < words; i++) {
        char *end;
        const char *word = glint_skip_blanks(at);
        const double number = glint_read_double(word, &end, text->c_locale);
        const bool is_number = end != word && glint_ends_word(*end);
        if (words == 3 && i > 0 && !is_number)
            break;
        if (numbers && i < 2 && is_number && number - number == 0)
            numbers[i] = number;
        for (at = word; !glint_ends_word(*at); at++)
            ;
    }
    return glint_skip_blanks(at);
}

static glint_status read_map(const glint_mesh_text *text, const char *at, map_kind kind, entry *to)
{
    glint_mesh_map *place = &to->place[kind];
    at = glint_skip_blanks(at);
    if (kind == MAP_BUMP) {
        to->height = 0;
        to->bm[0] = 0;
    }
    for (int words; (words = option_words(at)) > 0;) {
        const char *option = at;
        at = skip_option(text, at, words,
                         glint_mesh_is_word(at, "-o")                        ? place->offset
                         : glint_mesh_is_word(at, "-s")                      ? place->scale
                         : kind == MAP_BUMP && glint_mesh_is_word(at, "-bm") ? &to->height
                                                                             : NULL);
        if (glint_mesh_is_word(option, "-clamp"))
            place->clamp = strncmp(glint_skip_blanks(option + 6), "on", 2) == 0;
        if (kind == MAP_BUMP && glint_mesh_is_word(option, "-bm")) {
            copy_name(to->bm, glint_skip_blanks(option + 3));
            to->bm[strcspn(to->bm, " \t")] = 0;
        }
    }
    if (!*at)
        return glint_mesh_refuse(text, "the name of a picture", at);
    to->bm_last = kind == MAP_BUMP ? strstr(at, " -bm ") != NULL : to->bm_last;
    free(to->map[kind]);
    to->map[kind] = glint_mesh_beside(text->path, at);
    return to->map[kind] ? GLINT_OK : glint_fail_nomem(text->error);
}

static const char *const map_words[MAP_COUNT] = { "map_Kd", "map_Ks", "map_d", "map_Bump" };
/// What a material has where its picture cannot be read.
static const char *const map_instead[MAP_COUNT] = { "its Kd", "its Ks", "its d", "no relief" };
static const char *const bump_words[] = { "map_bump", "bump" }; ///< other spellings of map_Bump

static glint_status read_field(const glint_mesh_text *text, const char *at, entry *to)
{
    double number = 0;
    glint_status status = GLINT_OK;
    if (glint_mesh_is_word(at, "Kd"))
        return read_color(text, at + 2, to->desc.diffuse);
    if (glint_mesh_is_word(at, "Ks")) {
        to->desc.has_specular = true;
        return read_color(text, at + 2, to->desc.specular);
    }
    if (glint_mesh_is_word(at, "Ns"))
        return read_range(text, at + 2, 1e308, &to->desc.shininess);
    if (glint_mesh_is_word(at, "d")) {
        status = read_range(text, at + 1, 1, &number);
        to->clear = status ? to->clear : 1 - number;
    } else if (glint_mesh_is_word(at, "Tr")) {
        status = read_range(text, at + 2, 1, &to->clear);
    } else if (glint_mesh_is_word(at, "illum")) {
        status = read_range(text, at + 5, 1e308, &number);
        to->dull = !status && number < 2;
    }
    for (int kind = 0; kind < MAP_COUNT; kind++)
        if (glint_mesh_is_word(at, map_words[kind]))
            status = read_map(text, at + strlen(map_words[kind]), (map_kind)kind, to);
    for (size_t i = 0; i < sizeof bump_words / sizeof *bump_words; i++)
        if (glint_mesh_is_word(at, bump_words[i]))
            status = read_map(text, at + strlen(bump_words[i]), MAP_BUMP, to);
    return status;
}

/// newmtl: the entry that the lines below are about. A second one of a name is another.
static glint_status begin(glint_mesh_library *library, const glint_mesh_text *text, const char *name, uint32_t *number)
{
    entry made = { .key = key_of(name), .desc = glint_material_desc_default() };
    for (int kind = 0; kind < MAP_COUNT; kind++)
        made.place[kind].scale[0] = made.place[kind].scale[1] = 1;
    copy_name(made.desc.name, name);
    glint_status status =
        glint_mesh_find(&library->known_set, &library->known, &made, sizeof(glint_key), number, text->error);
    if (status)
        return status;
    free_maps(known_at(library, *number));
    *known_at(library, *number) = made;
    return GLINT_OK;
}

static glint_status read_lines(glint_mesh_library *library, glint_mesh_text *text)
{
    bool more = true;
    uint32_t number = NO_FACE;
    while (more) {
        glint_status status = glint_mesh_next_line(text, false, &more);
        if (status || !more)
            return status;
        size_t length = strlen(text->line);
        while (length > 0 && glint_is_blank(text->line[length - 1]))
            text->line[--length] = 0;
        const char *at = glint_skip_blanks(text->line);
        if (glint_mesh_is_word(at, "newmtl"))
            status = begin(library, text, glint_skip_blanks(at + 6), &number);
        else if (number != NO_FACE)
            status = read_field(text, at, known_at(library, number));
        if (status)
            return status;
    }
    return GLINT_OK;
}

// ---- Files ----

/// Reads one; *there: it could be opened. What is wrong with it is a warning, and what stands above that is taken.
static glint_status read_file(glint_mesh_library *library, const glint_mesh_reader *reader, const char *path, bool last,
                              bool *there)
{
    glint_mesh_text text;
    glint_error inner;
    glint_status status = glint_mesh_text_open(&text, path, &inner);
    *there = !status;
    if ((!status || last) && reader->desc->reads)
        reader->desc->reads(reader->desc->context, path);
    if (!status)
        status = read_lines(library, &text);
    glint_mesh_text_close(&text);
    if (status == GLINT_ERR_NOMEM)
        return glint_fail_nomem(reader->error);
    library->told = library->told || (status && (*there || last));
    if (status && (*there || last))
        glint_mesh_warn(reader->desc, reader->text.path, "its materials are not all there: %.300s", inner.message);
    return GLINT_OK;
}

/// The whole of `names` is a file, which may have blanks in its name, or each word of it is one.
glint_status glint_mesh_library_read(glint_mesh_library *library, const glint_mesh_reader *reader, const char *names)
{
    bool there = false;
    char *path = glint_mesh_beside(reader->text.path, names), *words = strdup(names), *rest = NULL;
    glint_status status = path && words ? GLINT_OK : glint_fail_nomem(reader->error);
    if (!status && !library->file)
        library->file = strdup(path);
    const bool several = strchr(names, ' ') || strchr(names, '\t');
    if (!status)
        status = read_file(library, reader, path, !several, &there);
    for (char *word = several && !status && !there ? strtok_r(words, " \t", &rest) : NULL; word && !status;
         word = strtok_r(NULL, " \t", &rest)) {
        char *one = glint_mesh_beside(reader->text.path, word);
        status = one ? read_file(library, reader, one, true, &there) : glint_fail_nomem(reader->error);
        free(one);
    }
    free(words);
    free(path);
    return status;
}

// ---- Pictures ----

/// The picture of a material; *out NULL, after a warning: there is none.
static glint_status find_picture(glint_mesh_library *library, const glint_mesh_reader *reader, const entry *e,
                                 map_kind kind, glint_texture **out)
{
    const bool how[2] = { e->place[kind].clamp, kind >= MAP_D };
    uint32_t number;
    glint_texture_desc desc = glint_texture_desc_default();
    glint_error inner;
    const size_t before = library->pictures.count;
    const picture wanted = { .key = glint_key_add(key_of(e->map[kind]), how, sizeof how) };
    glint_status status =
        glint_mesh_find(&library->picture_set, &library->pictures, &wanted, sizeof(glint_key), &number, reader->error);
    *out = NULL;
    if (status)
        return status;
    picture *found = (picture *)library->pictures.items + number;
    if (library->pictures.count > before) {
        desc.path = e->map[kind];
        desc.linear = kind >= MAP_D; // numbers, not colours
        desc.wrap = e->place[kind].clamp ? GLINT_WRAP_CLAMP : GLINT_WRAP_REPEAT;
        if (reader->desc->reads)
            reader->desc->reads(reader->desc->context, e->map[kind]);
        status = glint_texture_create(&desc, &found->texture, &inner);
        if (status == GLINT_ERR_NOMEM)
            return glint_fail_nomem(reader->error);
        if (status)
            glint_mesh_warn(reader->desc, reader->text.path, "material '%s' has %s in place of its %s: %.200s",
                            e->desc.name, map_instead[kind], map_words[kind], inner.message);
    }
    *out = found->texture;
    return GLINT_OK;
}

// ---- Materials ----

/// Of what is seen through, d of the light is the surface's own.
static void dissolve(entry *e)
{
    for (int c = 0; c < 3; c++) {
        e->desc.specular[c] *= e->dull ? 0 : 1 - e->clear;
        e->desc.diffuse[c] *= 1 - e->clear;
        e->desc.transmission[c] = e->clear;
    }
    if (e->clear > 0)
        e->desc.ior = 1;
}

/// Whether the relief of a material has a height. Those without are counted.
static bool has_height(glint_mesh_library *library, const entry *e)
{
    if (e->height == 0 && library->flat++ == 0)
        library->first_flat = *e;
    return e->height != 0;
}

/// The pattern of one of its pictures, times what the file says beside it.
static glint_status paint(glint_mesh_library *library, const glint_mesh_reader *reader, const entry *e, map_kind kind,
                          glint_program **out)
{
    static const double one[3] = { 1, 1, 1 };
    const double *const ks = e->desc.has_specular || e->dull ? e->desc.specular : one;
    const double height[3] = { e->height };
    const double *const factor[MAP_COUNT] = { e->desc.diffuse, ks, one, height };
    glint_texture *texture = NULL;
    glint_status status = GLINT_OK;
    if (!e->map[kind] || (kind == MAP_BUMP && !has_height(library, e)))
        return GLINT_OK;
    if (e->lacks_uv)
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s' has %s in place of its %s: faces of it have no coordinates (vt)", e->desc.name,
                        map_instead[kind], map_words[kind]);
    else
        status = find_picture(library, reader, e, kind, &texture);
    bool grey = true;
    if (!status && texture && kind == MAP_BUMP)
        status = glint_mesh_find_grey(texture, &grey, reader->error);
    if (!status && !grey) {
        glint_mesh_warn(
            reader->desc, reader->text.path,
            "material '%s' has no relief in place of its map_Bump: heights in grey expected, and the picture "
            "has colours, as pictures of normals do",
            e->desc.name);
        return status;
    }
    if (!status && texture)
        status = glint_mesh_paint(texture, &e->place[kind], factor[kind], kind >= MAP_D ? 1 : 3, out, reader->error);
    return status;
}

static glint_status make_material(glint_mesh_library *library, const glint_mesh_reader *reader, uint32_t number)
{
    entry e = *used_at(library, number);
    glint_material *material;
    glint_program *made[MAP_COUNT] = { NULL };
    glint_status status = GLINT_OK;
    dissolve(&e);
    for (int kind = 0; kind < MAP_COUNT && !status; kind++)
        status = paint(library, reader, &e, (map_kind)kind, &made[kind]);
    e.desc.program.diffuse = made[MAP_KD];
    e.desc.program.specular = made[MAP_KS];
    e.desc.program.opacity = made[MAP_D];
    e.desc.program.bump = made[MAP_BUMP];
    e.desc.has_specular = e.desc.has_specular || made[MAP_KS];
    if (!status)
        status = glint_material_create(&e.desc, &material, reader->error);
    for (int kind = 0; kind < MAP_COUNT; kind++)
        glint_program_release(made[kind]);
    if (status)
        return status;
    status = glint_mesh_append(&library->materials, &material, reader->error);
    if (status)
        glint_material_release(material);
    return status;
}

/// Notes which materials have faces without coordinates.
static void find_uv(glint_mesh_library *library, const glint_mesh_reader *reader)
{
    const uint32_t *sizes = reader->sizes.items, *index = reader->material_index.items, *uv = reader->corner_uv.items;
    for (size_t i = 0, corner = 0; i < reader->sizes.count; corner += sizes[i++])
        for (uint32_t j = 0; j < sizes[i]; j++)
            if (!reader->corner_uv.count || uv[corner + j] == GLINT_NO_UV)
                used_at(library, index[i])->lacks_uv = true;
}

/// Faces without a usemtl, or with one that no file has, get a material with default fields.
static glint_status look_up(glint_mesh_library *library, const glint_mesh_reader *reader, entry *used)
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
        *used = *known_at(library, number);
        used->lacks_uv = lacks_uv;
    } else if (library->missing++ == 0) {
        memcpy(library->first_missing, used->desc.name, sizeof library->first_missing);
    }
    return GLINT_OK;
}

/// " and 2 more" of `count`; "" of 1.
static const char *spell_more(size_t count, char out[32])
{
    out[0] = 0;
    if (count > 1)
        snprintf(out, 32, " and %zu more", count - 1);
    return out;
}

/// Once.
static void tell_flat(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    const entry *e = &library->first_flat;
    if (!library->flat)
        return;
    spell_more(library->flat, more);
    if (e->bm[0])
        glint_mesh_warn(reader->desc, reader->text.path,
                        "material '%s'%s: no relief: -bm of map_Bump: a height in world units other than 0 expected, "
                        "got '%s'",
                        e->desc.name, more, e->bm);
    else
        glint_mesh_warn(reader->desc, reader->text.path, "material '%s'%s: no relief: map_Bump has %s", e->desc.name, more,
                        e->bm_last ? "its -bm after the picture's name; options come before it"
                                   : "no -bm, which says how high it is, in world units");
}

/// Once, and not where a file that was not read is the reason.
static void tell_missing(const glint_mesh_library *library, const glint_mesh_reader *reader)
{
    char more[32];
    if (library->missing && !library->told)
        glint_mesh_warn(reader->desc, reader->text.path, "material '%s'%s: %s%.200s", library->first_missing,
                        spell_more(library->missing, more),
                        library->file ? "not in " : "the mesh names no file of materials (mtllib)",
                        library->file ? library->file : "");
}

glint_status glint_mesh_library_make(glint_mesh_library *library, const glint_mesh_reader *reader)
{
    glint_status status = GLINT_OK;
    find_uv(library, reader);
    for (uint32_t i = 0; i < library->used.count && !status; i++) {
        status = look_up(library, reader, used_at(library, i));
        if (!status)
            status = make_material(library, reader, i);
    }
    if (!status) {
        tell_missing(library, reader);
        tell_flat(library, reader);
    }
    return status;
}

void glint_mesh_library_give(const glint_mesh_library *library, const glint_mesh_reader *reader, glint_mesh_desc *desc)
{
    desc->materials = library->materials.items;
    desc->material_count = library->materials.count;
    desc->material_index = reader->material_index.items;
}
