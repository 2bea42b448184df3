#include "engine/base/number.h"
#include "engine/base/status.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 0x1.921fb54442d18p+1

int glint_field_numbers(const glint_object_field *field)
{
    if (field->type == GLINT_TYPE_NUMBER || field->type == GLINT_TYPE_ANGLE)
        return 1;
    return field->type >= GLINT_TYPE_VECTOR && field->type <= GLINT_TYPE_COLOR ? 3 : 0;
}

void glint_fields_reset(const glint_object_field *fields, void *desc)
{
    for (const glint_object_field *f = fields; f->name; f++) {
        char *at = (char *)desc + f->offset;
        const int value = (int)f->initial[0];
        const int64_t whole = (int64_t)f->initial[0];
        if (f->type == GLINT_TYPE_FLAG)
            *(bool *)at = value;
        else if (f->type == GLINT_TYPE_CHOICE)
            memcpy(at, &value, sizeof value);
        else if (f->type == GLINT_TYPE_WHOLE)
            memcpy(at, &whole, sizeof whole);
        else
            memcpy(at, f->initial, (size_t)glint_field_numbers(f) * sizeof(double));
    }
}

/// Checks a number against the range of its row. Both ends 0 and no text: any number.
static glint_status check_number(const glint_object_field *f, double v, glint_error *error)
{
    char range[64];
    if (!f->expected && f->low == f->high)
        return GLINT_OK;
    glint_print(range, sizeof range, "number %.15g .. %.15g", f->low, f->high);
    return glint_check_range(f->name, v, f->low, f->high, f->expected ? f->expected : range, error);
}

static glint_status check_color(const glint_object_field *f, const double v[3], glint_error *error)
{
    glint_status status = glint_check_color(f->name, v, error);
    for (int c = 0; c < 3 && !status && f->high > 0; c++)
        if (v[c] > f->high)
            status = glint_fail(error, GLINT_ERR_INVALID, "%s: at most %g expected, got %g: %s", f->name, f->high, v[c], f->expected);
    return status;
}

static glint_status check_choice(const glint_object_field *f, unsigned value, glint_error *error)
{
    unsigned count = 0;
    while (f->names[count])
        count++;
    return value < count ? GLINT_OK : glint_fail(error, GLINT_ERR_INVALID, "%s: no such %s", f->name, f->name);
}

/// Returns whether a field of a description is set, by its flags.
static bool is_given(const glint_object_field *f, const void *desc)
{
    const bool *flags = desc;
    return (!f->set_offset || flags[f->set_offset]) && !(f->unset_offset && flags[f->unset_offset]);
}

static glint_status check(const glint_object_field *f, const char *desc, glint_error *error);

/// Checks the parts of a table; messages name "table.part".
static glint_status check_parts(const glint_object_field *table, const char *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    char name[64];
    for (const glint_object_field *f = table->parts; f->name && !status; f++) {
        glint_object_field part = *f;
        part.name = name;
        snprintf(name, sizeof name, "%s.%s", table->name, f->name);
        if (is_given(f, desc))
            status = check(&part, desc, error);
    }
    return status;
}

static glint_status check(const glint_object_field *f, const char *desc, glint_error *error)
{
    const char *at = desc + f->offset;
    double v[3] = { 0 };
    int64_t whole;
    unsigned choice;
    memcpy(v, at, (size_t)glint_field_numbers(f) * sizeof *v);
    switch (f->type) {
    case GLINT_TYPE_NUMBER:
        return check_number(f, *v, error);
    case GLINT_TYPE_WHOLE:
        memcpy(&whole, at, sizeof whole);
        if (f->expected && !(whole >= f->low && whole <= f->high))
            return glint_fail(error, GLINT_ERR_INVALID, "%s: %s expected, got %lld", f->name, f->expected, (long long)whole);
        return glint_check_whole(f->name, whole, (int64_t)f->low, (int64_t)f->high, error);
    case GLINT_TYPE_ANGLE:
        if (!f->expected || (*v >= f->low && *v <= f->high))
            return GLINT_OK;
        return glint_fail(error, GLINT_ERR_INVALID, "%s: %s expected, got %.15g", f->name, f->expected, *v * 180 / PI);
    case GLINT_TYPE_VECTOR:
        return f->high > 0 ? glint_check_color(f->name, v, error) : glint_check_vector(f->name, v, error);
    case GLINT_TYPE_DIRECTION:
        return glint_check_direction(f->name, v, error);
    case GLINT_TYPE_COLOR:
        return check_color(f, v, error);
    case GLINT_TYPE_TRANSFORM:
        return glint_check_transform(f->name, (const glint_transform *)(const void *)at, error);
    case GLINT_TYPE_TABLE:
        return check_parts(f, desc, error);
    case GLINT_TYPE_TEXT:
        if (memchr(at, '\0', GLINT_NAME_SIZE))
            return GLINT_OK;
        return glint_fail(error, GLINT_ERR_INVALID, "%s: at most %d bytes and a NUL expected", f->name, GLINT_NAME_SIZE - 1);
    case GLINT_TYPE_CHOICE:
        memcpy(&choice, at, sizeof choice);
        return check_choice(f, choice, error);
    default:
        return GLINT_OK;
    }
}

glint_status glint_fields_check(const glint_object_field *fields, const void *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    for (const glint_object_field *f = fields; f->name && !status; f++)
        if (is_given(f, desc))
            status = check(f, desc, error);
    return status;
}
