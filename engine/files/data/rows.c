/// Reads rows of numbers and words from text.
#include "engine/base/pool.h"
#include "engine/files/data/decimal.h"
#include "engine/files/data/words.h"

#include <math.h>
#include <string.h>

#define PARTS_MAX 16
#define PART_BYTES ((size_t)1 << 17) ///< less text is not worth a thread

/// A position in a line. `end` is the position of its newline.
typedef struct cursor {
    const char *at, *end;
} cursor;

typedef struct text_part {
    const char *at;
    size_t length;
} text_part;

static inline bool is_space(char c) { return c == ' ' || (unsigned char)(c - '\t') < 5; }

static inline const char *word_end(const char *at, const char *end)
{
    while (at < end && ((unsigned char)*at > ' ' || !is_space(*at)))
        at++;
    return at;
}

/// Takes the next field of a line whose fields are separated by spaces. False: there is none.
static inline bool take_word(cursor *line, text_part *out)
{
    const char *at = line->at, *const end = line->end;
    while (at < end && is_space(*at))
        at++;
    out->at = at;
    line->at = word_end(at, end);
    out->length = (size_t)(line->at - at);
    return out->length > 0;
}

static text_part trimmed(const char *from, const char *to)
{
    while (from < to && is_space(*from))
        from++;
    while (to > from && is_space(to[-1]))
        to--;
    return (text_part) { from, (size_t)(to - from) };
}

/// Takes the next field of a line with separators. `at` is NULL after the last field. False: there is none, or its
/// quotes need care.
static bool take_field(cursor *line, char separator, text_part *out)
{
    if (!line->at)
        return false;
    const char *from = line->at;
    while (from < line->end && *from != separator && is_space(*from))
        from++;
    if (from < line->end && *from == '"') {
        const char *close = memchr(from + 1, '"', (size_t)(line->end - from - 1));
        if (!close)
            return false;
        *out = (text_part) { from + 1, (size_t)(close - from - 1) };
        for (from = close + 1; from < line->end && *from != separator; from++)
            if (!is_space(*from))
                return false; // also a doubled quote
        line->at = from < line->end ? from + 1 : NULL;
        return true;
    }
    const char *to = memchr(from, separator, (size_t)(line->end - from));
    *out = trimmed(from, to ? to : line->end);
    line->at = to ? to + 1 : NULL;
    return true;
}

static bool is_missing(text_part text)
{
    // NA is in capitals because Na is an element.
    static const char *const names[] = { "nan", "-nan", "+nan", "-1.#ind", "1.#qnan", "n/a", "null" };
    char small[8];
    if (text.length == 0 || (text.length == 2 && memcmp(text.at, "NA", 2) == 0))
        return true;
    if (text.length >= sizeof small)
        return false;
    for (size_t i = 0; i < text.length; i++)
        small[i] = (char)(text.at[i] >= 'A' && text.at[i] <= 'Z' ? text.at[i] - 'A' + 'a' : text.at[i]);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strlen(names[i]) == text.length && memcmp(names[i], small, text.length) == 0)
            return true;
    return false;
}

/// Returns whether a text without a point is a number of Fortran: 1D3, 1-3. In a column of values it may be a date.
static bool is_doubtful(text_part text)
{
    for (size_t i = 1; i < text.length; i++) {
        const char c = text.at[i], before = text.at[i - 1];
        if (c == 'd' || c == 'D' || ((c == '-' || c == '+') && before != 'e' && before != 'E'))
            return !memchr(text.at, '.', text.length);
    }
    return false;
}

/// Reads a field into row `row` of a column. False: it is not of the column's kind.
static inline bool read_field(const glint_column *column, text_part text, size_t row)
{
    double number;
    if (column->kind == GLINT_COLUMN_WORD) {
        const int64_t index = glint_words_find(column->words, text.at, text.length);
        if (index >= 0 && column->indices)
            column->indices[row] = index;
        return index >= 0;
    }
    if (!glint_read_decimal(text.at, text.length, &number)) {
        if (column->kind != GLINT_COLUMN_VALUE || !is_missing(text))
            return false;
        number = (double)NAN;
    } else if (!isfinite(number) || (column->kind == GLINT_COLUMN_SIZE && !(number > 0)) ||
               (column->kind == GLINT_COLUMN_VALUE && is_doubtful(text)))
        return false;
    if (column->numbers)
        column->numbers[row] = number;
    return true;
}

static bool read_fixed(const glint_rows_desc *desc, cursor line, size_t row)
{
    const size_t length = (size_t)(line.end - line.at);
    if (memchr(line.at, '\t', length))
        return false;
    for (const glint_column *column = desc->columns; column < desc->columns + desc->column_count; column++) {
        if (length < column->field + column->width)
            return false;
        text_part text = { line.at + column->field, column->width };
        if (column->kind != GLINT_COLUMN_WORD)
            text = trimmed(text.at, text.at + text.length);
        if (!read_field(column, text, row))
            return false;
    }
    return true;
}

static bool read_row(const glint_rows_desc *desc, cursor line, size_t row)
{
    if (desc->is_fixed)
        return read_fixed(desc, line, row);
    const glint_column *column = desc->columns, *const last = column + desc->column_count;
    text_part text;
    for (size_t field = 0;; field++) {
        if (column == last && !desc->field_count)
            return true;
        if (desc->separator ? !take_field(&line, desc->separator, &text) : !take_word(&line, &text))
            return column == last && field == desc->field_count && (!desc->separator || !line.at);
        for (; column < last && column->field == field; column++)
            if (!read_field(column, text, row))
                return false;
    }
}

static bool is_skipped(const char *at, const char *end)
{
    while (at < end && is_space(*at))
        at++;
    return at == end || *at == '#';
}

/// The lines of one worker. Its first row is row `first` of the columns, the number of lines before it.
typedef struct part {
    const char *at, *end; ///< the text that has not been read
    size_t first, rows, lines;
} part;

typedef struct reading {
    const glint_rows_desc *desc;
    size_t most;
    part parts[PARTS_MAX];
} reading;

static void read_part(void *context, size_t index, int worker)
{
    reading *r = context;
    part *p = &r->parts[index];
    (void)worker;
    for (const char *newline; p->at < p->end && p->first + p->rows < r->most; p->lines++, p->at = newline + 1) {
        newline = memchr(p->at, '\n', (size_t)(p->end - p->at));
        if (!newline)
            break;
        if (r->desc->skips && is_skipped(p->at, newline))
            continue;
        if (!read_row(r->desc, (cursor) { p->at, newline }, p->first + p->rows))
            break;
        p->rows++;
    }
}

/// Splits the text after ends of lines. Returns the number of parts.
static size_t split(reading *r, const char *text, size_t length, size_t count)
{
    const char *at = text, *const end = text + length;
    size_t line = 0, i = 0;
    for (; i + 1 < count && line < r->most; i++) {
        part *p = &r->parts[i];
        *p = (part) { .at = at, .first = line };
        for (const char *to = text + length / count * (i + 1); at < to; line++) {
            const char *newline = memchr(at, '\n', (size_t)(end - at));
            at = newline ? newline + 1 : end;
        }
        p->end = at;
    }
    if (line < r->most)
        r->parts[i++] = (part) { .at = at, .end = end, .first = line };
    return i;
}

/// Moves the rows of a part in all columns to row `to`, after skipped lines.
static void move_rows(const glint_rows_desc *desc, const part *p, size_t to)
{
    for (const glint_column *column = desc->columns; column < desc->columns + desc->column_count; column++) {
        if (column->kind == GLINT_COLUMN_WORD && column->indices)
            memmove(column->indices + to, column->indices + p->first, p->rows * sizeof *column->indices);
        else if (column->kind != GLINT_COLUMN_WORD && column->numbers)
            memmove(column->numbers + to, column->numbers + p->first, p->rows * sizeof *column->numbers);
    }
}

size_t glint_rows_read(const glint_rows_desc *desc, const char *text, size_t length, size_t most, size_t *used,
                       size_t *lines)
{
    reading r = { .desc = desc, .most = most };
    glint_pool *pool = NULL;
    const size_t threads = (size_t)(desc->threads ? desc->threads : glint_pool_processors());
    size_t rows = 0, parts = threads < PARTS_MAX ? threads : PARTS_MAX;
    parts = split(&r, text, length, parts < length / PART_BYTES ? parts : length / PART_BYTES);
    if (parts > 1)
        glint_pool_create((int)parts, &pool, NULL); // without a pool, this thread reads all parts
    glint_run_items(pool, parts, read_part, &r);
    glint_pool_destroy(pool);
    *used = *lines = 0;
    for (part *p = r.parts; p < r.parts + parts; p++) {
        if (rows != p->first)
            move_rows(desc, p, rows);
        rows += p->rows;
        *lines += p->lines;
        *used = (size_t)(p->at - text);
        if (p->at != p->end)
            break;
    }
    return rows;
}
