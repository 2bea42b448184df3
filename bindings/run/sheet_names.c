// The names of a sheet's axes and the formats of their values, as "axis=text" lines.
#include <stdlib.h>
#include <string.h>

#include "bindings/run/sheet.h"

static const char *skip_digits(const char *at)
{
    for (int i = 0; i < 2 && *at >= '0' && *at <= '9'; i++)
        at++;
    return at;
}

// Returns the last character of the conversion at `at`, which begins with '%'. NULL: it does not convert a number, as
// "%+8.2f" does.
static const char *find_conversion(const char *at)
{
    at = skip_digits(at + 1 + strspn(at + 1, "+-# 0"));
    if (*at == '.')
        at = skip_digits(at + 1);
    return *at && strchr("eEfgG", *at) ? at : NULL;
}

// Returns whether a text has one conversion of a number, and no other conversion.
static bool is_format(const char *text, size_t size)
{
    int conversions = 0;
    for (const char *at = text; at && at < text + size; at++) {
        if (*at != '%')
            continue;
        conversions += at[1] != '%';
        at = at[1] == '%' ? at + 1 : find_conversion(at);
        if (!at)
            return false;
    }
    return conversions == 1;
}

static bool check_format(const char *text, size_t size, char *message)
{
    if (size <= GLINTL_FORMAT_MAX && is_format(text, size))
        return true;
    return glintL_complain(message,
                           "format: at most %d bytes with one number such as %%.2f, %%g or %%e expected, got '%.*s'",
                           GLINTL_FORMAT_MAX, (int)(size < 100 ? size : 100), text);
}

static bool check_name(const char *text, size_t size, char *message)
{
    (void)text;
    if (size > 0 && size <= GLINTL_AXIS_NAME_MAX)
        return true;
    return glintL_complain(message, "names: a name of 1 .. %d bytes expected, got %zu bytes", GLINTL_AXIS_NAME_MAX,
                           size);
}

// Checks "axis=text" lines. False: the message says what is wrong.
static bool check_lines(const char *field, const char *lines, bool (*check)(const char *, size_t, char *), char *message)
{
    while (lines && *lines) {
        const size_t size = strcspn(lines, "\n"), name = strcspn(lines, "=\n") + 1;
        if (name > size)
            return glintL_complain(message, "%s: AXIS=TEXT expected, got '%.*s'", field, (int)(size < 100 ? size : 100),
                                   lines);
        if (!check(lines + name, size - name, message))
            return false;
        lines += size + (lines[size] == '\n');
    }
    return true;
}

bool glintL_sheet_check_names(const glintL_sheet *sheet, char message[GLINTL_MESSAGE_SIZE])
{
    return check_lines("names", sheet->names, check_name, message) &&
           check_lines("format", sheet->formats, check_format, message);
}

// Writes that no axis is called `name`, and which one is similar.
static void complain_axis(const char *field, const char *name, const char *axes, char *message)
{
    char known[GLINTL_AXIS_NAME_MAX + 1], near[GLINTL_AXIS_NAME_MAX + 1] = "";
    for (const char *at = axes; *at; at += strcspn(at, "\n"), at += *at == '\n') {
        snprintf(known, sizeof known, "%.*s", (int)strcspn(at, "="), at);
        if (glintL_nearer(name, *near ? near : NULL, known) == known)
            memcpy(near, known, sizeof near);
    }
    snprintf(message, GLINTL_MESSAGE_SIZE, "%s: the sheet has no axis '%s'%s%s%s", field, name,
             *near ? "; did you mean '" : "", near, *near ? "'?" : "");
}

static bool check_axes(const char *field, const char *lines, bool has_default, const char *axes, char *message)
{
    char name[GLINTL_AXIS_NAME_MAX + 1];
    size_t unused;
    while (lines && *lines) {
        const size_t size = strcspn(lines, "\n"), length = strcspn(lines, "=");
        if ((length || !has_default) && !glintL_find_line(axes, lines, length, &unused)) {
            snprintf(name, sizeof name, "%.*s", (int)length, lines);
            complain_axis(field, name, axes, message);
            return false;
        }
        lines += size + (lines[size] == '\n');
    }
    return true;
}

bool glintL_sheet_check_axes(const glintL_sheet *sheet, const char *axes, char message[GLINTL_MESSAGE_SIZE])
{
    return check_axes("names", sheet->names, false, axes, message) && check_axes("format", sheet->formats, true, axes, message);
}

// Copies the text of an axis from "axis=text" lines. False: it has none.
static bool copy_text(const char *lines, const char *axis, char *out, size_t size)
{
    const size_t name = strlen(axis);
    size_t length = 0;
    const char *line = glintL_find_line(lines, axis, name, &length);
    if (line)
        snprintf(out, size, "%.*s", (int)(length - name - 1), line + name + 1);
    return line != NULL;
}

void glintL_axis_title(const glintL_sheet *sheet, const glintL_axis *axis, char out[GLINTL_AXIS_SIZE])
{
    if (!copy_text(sheet->names, axis->name, out, GLINTL_AXIS_SIZE))
        snprintf(out, GLINTL_AXIS_SIZE, "%s", axis->name);
}

void glintL_axis_spell(const glintL_sheet *sheet, const glintL_axis *axis, size_t i, char out[GLINTL_AXIS_SIZE])
{
    char *end, format[GLINTL_FORMAT_MAX + 1];
    const char *value = axis->values[i];
    double number = strtod(value, &end);
    if (end == value || *end != '\0')
        snprintf(out, GLINTL_AXIS_SIZE, "%.60s", value);
    else if (copy_text(sheet->formats, axis->name, format, sizeof format) || copy_text(sheet->formats, "", format, sizeof format))
        snprintf(out, GLINTL_AXIS_SIZE, format, number); // glintL_sheet_check has checked the format
    else
        snprintf(out, GLINTL_AXIS_SIZE, number < 1e4 && number > -1e4 ? "%.4g" : "%.6g", number);
}
