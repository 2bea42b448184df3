#include "engine/base/status.h"
#include "engine/scene/objects.h"
#include "engine/stages/stages.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

glint_material_desc glint_material_desc_default(void)
{
    return (glint_material_desc) {
        .model = GLINT_MODEL_PHONG, .diffuse = { 0.8, 0.8, 0.8 }, .shininess = 32, .roughness = 0.3, .ior = 1.5, .opacity = 1
    };
}

static glint_status check_f0(const double f0[3], glint_error *error)
{
    glint_status status = glint_check_color("f0", f0, error);
    for (int c = 0; c < 3 && !status; c++)
        if (f0[c] > 1)
            status =
                glint_fail(error, GLINT_ERR_INVALID, "f0: at most 1 expected, got %g: no surface reflects more", f0[c]);
    return status;
}

static glint_status check(const glint_material_desc *desc, glint_error *error)
{
    glint_status status = GLINT_OK;
    if (desc->model > GLINT_MODEL_COOK_TORRANCE)
        status = glint_fail(error, GLINT_ERR_INVALID, "model: no such model");
    if (!status && desc->has_ambient)
        status = glint_check_color("ambient", desc->ambient, error);
    if (!status)
        status = glint_check_color("diffuse", desc->diffuse, error);
    if (!status)
        status = glint_check_color("specular", desc->specular, error);
    if (!status)
        status = glint_check_range("shininess", desc->shininess, 0, 1.7976931348623157e308, "number >= 0", error);
    if (!status && desc->has_mirror)
        status = glint_check_color("mirror", desc->mirror, error);
    if (!status)
        status = glint_check_color("transmission", desc->transmission, error);
    if (!status)
        status =
            glint_check_range("ior", desc->ior, 4.9406564584124654e-324, 1.7976931348623157e308, "number > 0", error);
    if (!status)
        status = glint_check_color("absorption", desc->absorption, error);
    if (!status)
        status = glint_check_range("roughness", desc->roughness, 0, 1, "number 0 .. 1", error);
    if (!status)
        status = glint_check_range("opacity", desc->opacity, 0, 1, "number 0 .. 1", error);
    if (!status && desc->opacity_mode > GLINT_OPACITY_BLEND)
        status = glint_fail(error, GLINT_ERR_INVALID, "opacity_mode: no such mode");
    if (!status && desc->distribution > GLINT_DISTRIBUTION_BECKMANN)
        status = glint_fail(error, GLINT_ERR_INVALID, "distribution: no such distribution");
    if (!status && desc->has_f0)
        status = check_f0(desc->f0, error);
    return status;
}

// ---- Programs ----

/// A field that takes a program: where it is, and where its numbers are.
typedef struct program_field {
    const char *name;
    size_t program, number; ///< offsets; number 0: none
    size_t count; ///< of numbers
    double most; ///< that they may be
    size_t set; ///< of the flag that they are given; 0: none
} program_field;

#define AT(member) offsetof(glint_material_desc, member)

static const program_field program_fields[] = {
    { "diffuse", AT(program.diffuse), AT(diffuse), 3, GLINT_REFLECTANCE_MAX, 0 },
    { "ambient", AT(program.ambient), AT(ambient), 3, GLINT_REFLECTANCE_MAX, AT(has_ambient) },
    { "specular", AT(program.specular), AT(specular), 3, GLINT_REFLECTANCE_MAX, AT(has_specular) },
    { "mirror", AT(program.mirror), AT(mirror), 3, GLINT_REFLECTANCE_MAX, AT(has_mirror) },
    { "transmission", AT(program.transmission), AT(transmission), 3, GLINT_REFLECTANCE_MAX, 0 },
    { "shininess", AT(program.shininess), AT(shininess), 1, GLINT_REFLECTANCE_MAX, 0 },
    { "roughness", AT(program.roughness), AT(roughness), 1, 1, 0 },
    { "bump", AT(program.bump), 0, 1, 0, 0 },
    { "opacity", AT(program.opacity), AT(opacity), 1, 1, 0 },
    { "model", AT(program.shader), 0, 0, 0, 0 },
};

static glint_program **program_at(const glint_material_programs *programs, const program_field *field)
{
    const size_t at = field->program - AT(program);
    return (glint_program **)(void *)((char *)(uintptr_t)programs + at);
}

#define EACH_FIELD(f) \
    for (const program_field *f = program_fields; f < program_fields + sizeof program_fields / sizeof *f; f++)

static void hold_programs(const glint_material_programs *programs)
{
    EACH_FIELD(f)
    if (*program_at(programs, f))
        glint_program_retain(*program_at(programs, f));
}

static void release_programs(const glint_material_programs *programs)
{
    EACH_FIELD(f)
    glint_program_release(*program_at(programs, f));
}

static glint_status check_program(const program_field *field, const glint_program *program, glint_error *error)
{
    const bool shader = glint_program_kind_of(program) == GLINT_PROGRAM_SHADER, wanted = field->count == 0;
    const size_t count = glint_program_output_count(program);
    if (shader != wanted)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: a %s expected, got a %s", field->name,
                          wanted ? "shader" : "pattern", wanted ? "pattern" : "shader");
    if (field->count == 1 && count != 1)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: a pattern of one number expected, got one of %zu", field->name,
                          count);
    return GLINT_OK;
}

bool glint_pattern_numbers(const glint_program *program, double most, double out[3])
{
    double value[GLINT_PROGRAM_OUTPUTS_MAX];
    const bool grey = glint_program_output_count(program) == 1;
    bool good = glint_program_kind_of(program) == GLINT_PROGRAM_PATTERN && glint_program_constant(program, value);
    for (size_t i = 0; i < glint_program_output_count(program); i++)
        good = good && value[i] >= 0 && value[i] <= most;
    for (int c = 0; c < 3 && good; c++)
        out[c] = value[grey ? 0 : c];
    return good;
}

/// Returns whether a number means the same as a pattern of that number. An opacity does not: by default patterns cut and numbers blend.
static bool means_the_same(const program_field *field, const double *value)
{
    return field->number != AT(opacity) || value[0] == 0 || value[0] == 1;
}

/// A pattern of numbers alone is these numbers. One height everywhere is no bump.
static void fold_program(const program_field *field, glint_material_desc *desc)
{
    double value[GLINT_PROGRAM_OUTPUTS_MAX];
    glint_program **program = program_at(&desc->program, field);
    if (field->count == 0 || (field->number ? !glint_pattern_numbers(*program, field->most, value)
                                            : !glint_program_constant(*program, value)) ||
        !means_the_same(field, value))
        return;
    if (field->number)
        memcpy((char *)desc + field->number, value, field->count * sizeof *value);
    if (field->set)
        *((bool *)desc + field->set) = true;
    *program = NULL;
}

/// Normalises -0 to 0, so that both hash to the same key.
static void drop_signs_of_zeros(glint_material_desc *desc)
{
    EACH_FIELD(f)
    for (size_t i = 0; f->number && i < f->count; i++)
        ((double *)(void *)((char *)desc + f->number))[i] += 0.0;
}

/// Checks a description, and puts numbers where its programs are nothing else.
static glint_status take(const glint_material_desc *desc, glint_material_desc *out, glint_error *error)
{
    *out = *desc;
    EACH_FIELD(f)
    {
        const glint_program *program = *program_at(&desc->program, f);
        glint_status status = program ? check_program(f, program, error) : GLINT_OK;
        if (status)
            return status;
        if (program)
            fold_program(f, out);
    }
    drop_signs_of_zeros(out);
    return check(out, error);
}

glint_status glint_material_create(const glint_material_desc *desc, glint_material **out, glint_error *error)
{
    GLINT_REFUSE_NULL(desc, error);
    GLINT_REFUSE_NULL(out, error);
    glint_material_desc taken;
    glint_status status = take(desc, &taken, error);
    if (status)
        return status;
    glint_material *material = malloc(sizeof *material);
    if (!material)
        return glint_fail_nomem(error);
    hold_programs(&taken.program);
    *material = (glint_material) { .references = 1, .desc = taken };
    *out = material;
    return GLINT_OK;
}

glint_status glint_material_set(glint_material *material, const glint_material_desc *desc, glint_error *error)
{
    GLINT_REFUSE_NULL(material, error);
    GLINT_REFUSE_NULL(desc, error);
    glint_material_desc taken;
    glint_status status = take(desc, &taken, error);
    if (status)
        return status;
    hold_programs(&taken.program);
    release_programs(&material->desc.program);
    material->desc = taken;
    return GLINT_OK;
}

const glint_material_desc *glint_material_get(const glint_material *material) { return &material->desc; }

glint_material *glint_material_retain(glint_material *material)
{
    if (material)
        material->references++;
    return material;
}

void glint_material_release(glint_material *material)
{
    if (!material || --material->references > 0)
        return;
    release_programs(&material->desc.program);
    free(material);
}

void glint_material_desc_resolve(glint_material_desc *desc)
{
    const double r = desc->ior < 1e300 ? (desc->ior - 1) / (desc->ior + 1) : 1;
    for (int c = 0; c < 3; c++) {
        if (!desc->has_ambient)
            desc->ambient[c] = desc->diffuse[c];
        if (!desc->has_specular && desc->model == GLINT_MODEL_COOK_TORRANCE)
            desc->specular[c] = 1;
        if (!desc->has_f0)
            desc->f0[c] = r * r;
        if (!desc->has_mirror)
            desc->mirror[c] = desc->fresnel;
    }
    desc->has_ambient = desc->has_specular = desc->has_f0 = desc->has_mirror = true;
}

static bool is_any(const double c[3]) { return c[0] > 0 || c[1] > 0 || c[2] > 0; }

bool glint_material_is_shiny(const glint_material_desc *desc)
{
    glint_material_desc d = *desc;
    glint_material_desc_resolve(&d);
    return !d.program.shader && d.model != GLINT_MODEL_LAMBERT && (d.program.specular || is_any(d.specular));
}

bool glint_material_transmits(const glint_material_desc *desc)
{
    return desc->program.transmission || is_any(desc->transmission);
}

bool glint_material_mirrors(const glint_material_desc *desc)
{
    return desc->program.mirror || (desc->has_mirror ? is_any(desc->mirror) : desc->fresnel);
}

bool glint_material_is_cut(const glint_material_desc *desc)
{
    if (desc->program.opacity)
        return desc->opacity_mode != GLINT_OPACITY_BLEND;
    return desc->opacity_mode == GLINT_OPACITY_CUT ? desc->opacity < 0.5 : desc->opacity == 0;
}

bool glint_material_blends(const glint_material_desc *desc)
{
    if (desc->program.opacity)
        return desc->opacity_mode == GLINT_OPACITY_BLEND;
    return desc->opacity_mode != GLINT_OPACITY_CUT && desc->opacity > 0 && desc->opacity < 1;
}

void glint_describe_material(const glint_material_desc *desc, const char *owner, char *out, size_t size)
{
    if (desc->name[0])
        snprintf(out, size, "material '%s'", desc->name);
    else
        snprintf(out, size, "material of %s", owner);
}
