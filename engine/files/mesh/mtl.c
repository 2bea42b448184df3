/// Reads the material files that .obj files name: the statements Kd, Ks, Ns, d ..., and names of pictures.
#include "engine/base/number.h"
#include "engine/files/mesh/entry.h"

#include "engine/base/status.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// ---- The statements of a file ----

/// The ignored lines and words of a .mtl file. Lines and words each give one warning.
typedef struct ignored_parts {
    size_t bad; ///< invalid lines
    glint_error first_bad;
    char words[160]; ///< unsupported statements, each listed once
} ignored_parts;

/// Adds a word to the list of unsupported statements unless it is there already.
static void add_word(const char *at, ignored_parts *ignored)
{
    char word[40];
    const size_t length = strcspn(at, " \t"), used = strlen(ignored->words);
    snprintf(word, sizeof word, " %.*s,", (int)(length < 32 ? length : 32), at);
    if (!strstr(ignored->words, word) && used + strlen(word) < sizeof ignored->words)
        strcpy(ignored->words + used, word);
}

/// Reads a colour; a single number stands for all three.
static glint_status read_color(const glint_mesh_text *text, const char *at, double out[3])
{
    if (glint_mesh_is_word(glint_skip_blanks(at), "spectral") || glint_mesh_is_word(glint_skip_blanks(at), "xyz"))
        return glint_mesh_refuse(text, "red, green and blue", glint_skip_blanks(at));
    double color[3];
    for (int c = 0; c < 3; c++) {
        at = glint_skip_blanks(at);
        if (c > 0 && (!*at || *at == '#')) {
            color[c] = color[c - 1];
            continue;
        }
        const char *start = at;
        glint_status status = glint_mesh_number(text, &at, &color[c]);
        if (status)
            return status;
        if (color[c] < 0)
            return glint_mesh_refuse(text, "numbers >= 0", start);
    }
    memcpy(out, color, sizeof color);
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
    glint_print(expected, sizeof expected, most < 1e300 ? "a number 0 .. %g" : "a number >= 0", most);
    if (!(number >= 0 && number <= most))
        return glint_mesh_refuse(text, expected, start);
    *out = number;
    return GLINT_OK;
}

/// Returns the number of words that a map option takes; 0: the word is not an option.
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

/// Reads the numbers of -o and -s; numbers after the first may be missing.
static const char *skip_option(const char *at, int words, double *numbers)
{
    while (!glint_ends_word(*at))
        at++;
    for (int i = 0; i < words; i++) {
        const char *end, *word = glint_skip_blanks(at);
        const double number = glint_mesh_read_double(word, &end);
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

/// The values of a map's options.
typedef struct map_options {
    glint_mesh_map mapping;
    double height; ///< -bm
    char bm[GLINT_NAME_SIZE]; ///< the text of the option -bm in the file
} map_options;

/// Reads options up to the first word that is not an option, and returns the position of that word.
static const char *read_options(const char *at, map_options *o, ignored_parts *ignored)
{
    for (int words; (words = option_words(at)) > 0;) {
        const char *option = at;
        double mm[2] = { 0, 1 };
        at = skip_option(at, words,
                         glint_mesh_is_word(at, "-o")    ? o->mapping.offset
                         : glint_mesh_is_word(at, "-s")  ? o->mapping.scale
                         : glint_mesh_is_word(at, "-bm") ? &o->height
                         : glint_mesh_is_word(at, "-mm") ? mm
                                                         : NULL);
        if (glint_mesh_is_word(option, "-clamp"))
            o->mapping.clamp = strncmp(glint_skip_blanks(option + 6), "on", 2) == 0;
        if (glint_mesh_is_word(option, "-bm")) {
            glint_mesh_copy_name(o->bm, glint_skip_blanks(option + 3));
            o->bm[strcspn(o->bm, " \t")] = 0;
        }
        if (mm[0] != 0 || mm[1] != 1 || glint_mesh_is_word(option, "-imfchan"))
            add_word(option, ignored);
    }
    return at;
}

/// Returns the end of a picture's name: the end of the line, or the start of the options that follow the name.
static const char *find_name_end(const char *at)
{
    const char *end = at;
    while ((end = strpbrk(end, " \t")) != NULL && option_words(glint_skip_blanks(end)) == 0)
        end = glint_skip_blanks(end);
    return end ? end : at + strlen(at);
}

/// Reads a picture with its options; the options of a statement without a picture are ignored.
static glint_status read_map(const glint_mesh_text *text, const char *at, glint_mesh_map_kind kind,
                             glint_mesh_entry *to, ignored_parts *ignored)
{
    map_options o = { .mapping = to->mapping[kind] };
    at = read_options(glint_skip_blanks(at), &o, ignored);
    const char *end = find_name_end(at);
    read_options(glint_skip_blanks(end), &o, ignored);
    if (end == at)
        return glint_mesh_refuse(text, "the name of a picture", at);
    char *name = strndup(at, (size_t)(end - at)), *path = name ? glint_mesh_sibling(text->path, name) : NULL;
    free(name);
    if (!path)
        return glint_fail_nomem(text->error);
    if (*at == '-' && access(path, F_OK) != 0) {
        free(path);
        return glint_mesh_refuse(text, "an option of a map or the name of a picture", at);
    }
    free(to->map[kind]);
    to->map[kind] = path;
    to->mapping[kind] = o.mapping;
    if (kind == GLINT_MAP_BUMP) {
        to->height = o.height;
        memcpy(to->bm, o.bm, sizeof o.bm);
    }
    return GLINT_OK;
}

const char *const glint_mesh_map_words[GLINT_MAP_COUNT] = { "map_Kd", "map_Ks", "map_d", "map_Bump" };
static const char *const bump_words[] = { "map_bump", "bump" }; ///< other spellings of map_Bump

/// Reads a statement about a picture. *known: it is such a statement.
static glint_status read_picture(const glint_mesh_text *text, const char *at, glint_mesh_entry *to,
                                 ignored_parts *ignored, bool *known)
{
    *known = true;
    for (int kind = 0; kind < GLINT_MAP_COUNT; kind++)
        if (glint_mesh_is_word(at, glint_mesh_map_words[kind]))
            return read_map(text, at + strlen(glint_mesh_map_words[kind]), (glint_mesh_map_kind)kind, to, ignored);
    for (size_t i = 0; i < sizeof bump_words / sizeof *bump_words; i++)
        if (glint_mesh_is_word(at, bump_words[i]))
            return read_map(text, at + strlen(bump_words[i]), GLINT_MAP_BUMP, to, ignored);
    *known = false;
    return GLINT_OK;
}

/// Reads a statement with one number. *known: it is such a statement. An invalid statement changes nothing.
static glint_status read_one(const glint_mesh_text *text, const char *at, glint_mesh_entry *to, bool *known)
{
    const struct {
        const char *word;
        double most, *out;
    } fields[] = { { "Ns", 1e308, &to->desc.shininess },
                   { "illum", 10, &to->illum },
                   { "Ni", 1e308, &to->ni },
                   { "Pr", 1, &to->rough },
                   { "Pm", 1, &to->metal } };
    double number = 0;
    *known = true;
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
        if (glint_mesh_is_word(at, fields[i].word))
            return read_range(text, at + strlen(fields[i].word), fields[i].most, fields[i].out);
    const bool is_d = glint_mesh_is_word(at, "d");
    *known = is_d || glint_mesh_is_word(at, "Tr");
    if (!*known)
        return GLINT_OK;
    glint_status status = read_range(text, at + (is_d ? 1 : 2), 1, &number);
    if (!status && (is_d || !to->has_d))
        to->clear = is_d ? 1 - number : number;
    to->has_d = to->has_d || (is_d && !status);
    return status;
}

/// Returns whether a statement has no effect: all its numbers are 0, or 1 for the transmission filter Tf.
static bool says_nothing(const char *at)
{
    const bool is_tf = glint_mesh_is_word(at, "Tf");
    while (!glint_ends_word(*at))
        at++;
    at = glint_skip_blanks(at);
    if (!*at)
        return false;
    for (; *at && *at != '#'; at = glint_skip_blanks(at)) {
        const char *end;
        const double number = glint_mesh_read_double(at, &end);
        if (!(number == 0 || (is_tf && number == 1)) || end == at || !glint_ends_word(*end))
            return false;
        at = end;
    }
    return true;
}

/// Notes an unsupported statement. Some statements are ignored without a note: Ka because ambient follows Kd, and
/// sharpness because it only matters together with another unsupported statement.
static void note_word(const char *at, ignored_parts *ignored)
{
    static const char *const silent[] = { "Ka", "map_Ka", "sharpness", "Km" };
    for (size_t i = 0; i < sizeof silent / sizeof *silent; i++)
        if (glint_mesh_is_word(at, silent[i]))
            return;
    if (*at && *at != '#' && !says_nothing(at))
        add_word(at, ignored);
}

static glint_status read_field(const glint_mesh_text *text, const char *at, glint_mesh_entry *to,
                               ignored_parts *ignored)
{
    bool known = true;
    glint_status status = GLINT_OK;
    if (glint_mesh_is_word(at, "Kd")) {
        status = read_color(text, at + 2, to->desc.diffuse);
    } else if (glint_mesh_is_word(at, "Ks")) {
        status = read_color(text, at + 2, to->desc.specular);
        to->desc.has_specular = to->desc.has_specular || !status;
    } else {
        status = read_one(text, at, to, &known);
        if (!known)
            status = read_picture(text, at, to, ignored, &known);
    }
    if (!known)
        note_word(at, ignored);
    return status;
}

/// Reads the statements of a file. Invalid ones are ignored.
static glint_status read_lines(glint_mesh_library *library, glint_mesh_text *text, ignored_parts *ignored)
{
    bool more = true;
    uint32_t number = GLINT_MESH_NO_FACE;
    for (;;) {
        glint_status status = glint_mesh_next_line(text, false, &more);
        if (status || !more)
            return status;
        size_t length = strlen(text->line);
        while (length > 0 && glint_is_blank(text->line[length - 1]))
            text->line[--length] = 0;
        const char *at = glint_skip_blanks(text->line);
        if (glint_mesh_is_word(at, "newmtl"))
            status = glint_mesh_library_begin(library, glint_skip_blanks(at + 6), &number, text->error);
        else if (number != GLINT_MESH_NO_FACE)
            status = read_field(text, at, glint_mesh_known_at(library, number), ignored);
        if (status == GLINT_ERR_FORMAT && ignored->bad++ == 0)
            ignored->first_bad = *text->error;
        if (status && status != GLINT_ERR_FORMAT)
            return status;
    }
}

// ---- Files ----

/// Writes the warnings about the ignored parts of a file.
static void warn_of_ignored(const glint_mesh_reader *reader, const char *path, ignored_parts *ignored)
{
    const size_t length = strlen(ignored->words);
    if (ignored->bad > 1)
        glint_mesh_warn(reader->desc, reader->text.path, "%.300s; the line is ignored, and %zu more",
                        ignored->first_bad.message, ignored->bad - 1);
    else if (ignored->bad)
        glint_mesh_warn(reader->desc, reader->text.path, "%.300s; the line is ignored", ignored->first_bad.message);
    if (!length)
        return;
    ignored->words[length - 1] = 0;
    glint_mesh_warn(reader->desc, reader->text.path, "%.200s:%s %s ignored: not a field of a material", path,
                    ignored->words, strchr(ignored->words, ',') ? "are" : "is");
}

/// Reads one file. *there: whether it could be opened. Faults in the file cause warnings.
static glint_status read_file(glint_mesh_library *library, const glint_mesh_reader *reader, const char *path, bool last,
                              bool *there)
{
    glint_mesh_text text;
    glint_error inner;
    ignored_parts ignored = { 0 };
    glint_status status = glint_mesh_text_open(&text, path, &inner);
    *there = !status;
    if ((!status || last) && reader->desc->reads)
        reader->desc->reads(reader->desc->context, path);
    if (!status && glint_mesh_text_is_utf16(&text))
        status = glint_fail(&inner, GLINT_ERR_FORMAT, "%s: is UTF-16, not UTF-8", path);
    if (!status)
        status = read_lines(library, &text, &ignored);
    glint_mesh_text_close(&text);
    warn_of_ignored(reader, path, &ignored);
    if (status == GLINT_ERR_NOMEM)
        return glint_fail_nomem(reader->error);
    library->reported = library->reported || (status && (*there || last));
    if (status && (*there || last))
        glint_mesh_warn(reader->desc, reader->text.path, "some of its materials are missing: %.300s", inner.message);
    return GLINT_OK;
}

/// Reads `names` as one file, whose name may contain blanks, or as several files, one per word, up to a comment.
glint_status glint_mesh_library_read(glint_mesh_library *library, const glint_mesh_reader *reader, const char *names)
{
    bool there = false;
    char *words = strdup(names), *rest = NULL;
    char *path = glint_mesh_sibling(reader->text.path, names);
    glint_status status = path && words ? GLINT_OK : glint_fail_nomem(reader->error);
    if (!status && !library->file)
        library->file = strdup(path);
    const bool several = *names != '"' && strpbrk(names, " \t");
    if (!status)
        status = read_file(library, reader, path, !several, &there);
    for (char *word = several && !status && !there ? strtok_r(words, " \t", &rest) : NULL;
         word && *word != '#' && !status; word = strtok_r(NULL, " \t", &rest)) {
        char *one = glint_mesh_sibling(reader->text.path, word);
        status = one ? read_file(library, reader, one, true, &there) : glint_fail_nomem(reader->error);
        free(one);
    }
    free(words);
    free(path);
    return status;
}
