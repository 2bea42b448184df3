#include "engine/base/status.h"
#include "engine/glint_programs.h"
#include "engine/render/scene/fields.h"
#include "engine/render/scene/objects.h"
#include "engine/render/stages/stages.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- The table of fields ----

typedef glint_material_desc DESC;

static const char *const models[] = { "phong", "blinn_phong", "lambert", "cook_torrance", NULL };
static const char *const opacity_modes[] = { "auto", "cut", "blend", NULL };
static const char *const distributions[] = { "ggx", "beckmann", NULL };

#define GIVEN(member) .set_offset = offsetof(DESC, member)
#define PROGRAM(member) .program_offset = offsetof(DESC, program.member)
#define COLORS (GLINT_TAKES_PATTERN | GLINT_TAKES_TEXTURE | GLINT_TAKES_VARIABLE)
#define NUMBERS (GLINT_TAKES_PATTERN | GLINT_TAKES_VARIABLE)

const glint_object_field glint_material_fields[] = {
    { GLINT_ROW(model, CHOICE), .names = models, PROGRAM(shader), .takes = GLINT_TAKES_SHADER,
      .doc = "model of the highlight; \"lambert\" has none; \"cook_torrance\" uses microfacets" },
    { GLINT_ROW(ambient, COLOR), GIVEN(has_ambient), .follows = "diffuse", PROGRAM(ambient), .takes = COLORS,
      .doc = "reflectance >= 0 for ambient light" },
    { GLINT_ROW(diffuse, COLOR), .initial = { 0.8, 0.8, 0.8 }, PROGRAM(diffuse), .takes = COLORS,
      .doc = "diffuse reflectance >= 0; a warning is given once for values above 1" },
    { GLINT_ROW(specular, COLOR), GIVEN(has_specular), PROGRAM(specular), .takes = COLORS,
      .doc = "strength >= 0 of the highlight. Default 0, with \"cook_torrance\" 1; nil restores the default" },
    { GLINT_ROW(shininess, NUMBER), GLINT_AT_LEAST_0, .initial = { 32 }, PROGRAM(shininess), .takes = NUMBERS,
      .doc = "exponent >= 0 of the highlight: higher is smaller and sharper" },
    { GLINT_ROW(normalized, FLAG),
      .doc = "for \"phong\" and \"blinn_phong\": the highlight is (s + 2)/2 (r.v)^s (n.l), or the same with n.h; "
             "reciprocal, and reflects no more light than it receives" },
    { GLINT_ROW(matched, FLAG), .doc = "for \"blinn_phong\": the exponent is 4 shininess, which looks most like Phong" },
    { GLINT_ROW(mirror, COLOR), GIVEN(has_mirror), PROGRAM(mirror), .takes = COLORS,
      .doc = "factor >= 0 for the light of the mirrored ray. With \"cook_torrance\" the facets reflect everything but "
             "lamps, whose highlights they have in any case. Default 0, with `fresnel` or \"cook_torrance\" 1; nil "
             "restores the default" },
    { GLINT_ROW(transmission, COLOR), PROGRAM(transmission), .takes = COLORS,
      .doc = "factor >= 0 for the light of the refracted ray, at each surface; total internal reflection is not multiplied by it" },
    { GLINT_ROW(ior, NUMBER), GLINT_ABOVE_0, .initial = { 1.5 }, .takes = GLINT_TAKES_VARIABLE,
      .doc = "refractive index inside, > 0; the index outside is 1, or the index of the surrounding object" },
    { GLINT_ROW(fresnel, FLAG),
      .doc = "true: `mirror` is multiplied by the reflectance of a dielectric at that angle, `transmission` by the "
             "rest" },
    { GLINT_ROW(absorption, COLOR), .takes = GLINT_TAKES_VARIABLE,
      .doc = ">= 0 per world unit: light inside is multiplied by exp(-absorption * distance)" },
    { GLINT_ROW(roughness, NUMBER), GLINT_SHARE, GIVEN(has_roughness), .initial = { 0.3 }, PROGRAM(roughness), .takes = NUMBERS,
      .doc = "0 .. 1, for \"cook_torrance\", mirrors and glass: the square root of the width of the distribution of "
             "the facets' slopes. Default 0.3 for \"cook_torrance\", where values below 1e-9 count as 1e-9, otherwise "
             "0: smooth; nil restores the default" },
    { GLINT_ROW(distribution, CHOICE), .names = distributions, .doc = "for rough surfaces: the distribution of the "
                                                                      "facets' slopes" },
    { GLINT_ROW(f0, COLOR), GIVEN(has_f0), .high = 1, .expected = "no surface reflects more", .follows = "ior",
      .takes = GLINT_TAKES_VARIABLE,
      .doc = "for \"cook_torrance\", 0 .. 1: reflectance at normal incidence; coloured for metals" },
    { .name = "bump", .type = GLINT_TYPE_PROGRAM, PROGRAM(bump), .takes = GLINT_TAKES_PATTERN, .unit = "world units",
      .doc = "height above the surface, which changes the normals that light, mirrors and glass use" },
    { GLINT_ROW(opacity, NUMBER), GLINT_SHARE, .initial = { 1 }, PROGRAM(opacity), .takes = NUMBERS,
      .doc = "0 .. 1: a number o lets the fraction 1 - o of each ray and of the light pass straight through, at each "
             "surface. Where a pattern is below 0.5, or NaN, no ray of a frame hits the surface; scene:cast still "
             "hits it" },
    { GLINT_ROW(opacity_mode, CHOICE), .names = opacity_modes,
      .doc = "\"auto\": numbers blend, patterns cut at 0.5; \"blend\": patterns blend, too; \"cut\": numbers cut, too" },
    { GLINT_ROW(name, TEXT), .doc = "used in messages and `glint explain`, at most 63 bytes" },
    { .name = NULL },
};

static glint_material_desc defaults(void)
{
    glint_material_desc desc = { .has_ambient = false };
    glint_fields_reset(glint_material_fields, &desc);
    return desc;
}

void glint_material_desc_init(glint_material_desc *desc, size_t size)
{
    const glint_material_desc full = defaults();
    glint_desc_write(desc, size, &full, sizeof full);
}

// ---- Programs ----

static glint_program **program_at(const glint_material_desc *desc, const glint_object_field *field)
{
    return (glint_program **)(void *)((char *)(uintptr_t)desc + field->program_offset);
}

#define EACH_PROGRAM(f) \
    for (const glint_object_field *f = glint_material_fields; f->name; f++) \
        if (f->program_offset)

static void hold_programs(const glint_material_desc *desc)
{
    EACH_PROGRAM(f)
    if (*program_at(desc, f))
        glint_program_retain(*program_at(desc, f));
}

static void release_programs(const glint_material_desc *desc)
{
    EACH_PROGRAM(f)
    glint_program_release(*program_at(desc, f));
}

static glint_status check_program(const glint_object_field *field, const glint_program *program, glint_error *error)
{
    const bool shader = glint_program_kind_of(program) == GLINT_PROGRAM_SHADER, wanted = field->takes & GLINT_TAKES_SHADER;
    const size_t count = glint_program_output_count(program);
    if (shader != wanted)
        return glint_fail(error, GLINT_ERR_INVALID, "%s: a %s expected, got a %s", field->name,
                          wanted ? "shader" : "pattern", wanted ? "pattern" : "shader");
    if (!wanted && field->type != GLINT_TYPE_COLOR && count != 1)
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

/// Returns whether a number means the same as a pattern of that number. For an opacity it does not: by default,
/// patterns cut and numbers blend.
static bool means_the_same(const glint_object_field *field, const double *value)
{
    return field->offset != offsetof(DESC, opacity) || value[0] == 0 || value[0] == 1;
}

/// Replaces a pattern that is constant by its numbers. A constant height is not a bump.
static void fold_program(const glint_object_field *field, glint_material_desc *desc)
{
    double value[GLINT_PROGRAM_OUTPUTS_MAX];
    glint_program **program = program_at(desc, field);
    const int count = glint_field_numbers(field);
    const double most = count == 1 ? fmin(field->high, GLINT_REFLECTANCE_MAX) : GLINT_REFLECTANCE_MAX;
    if (field->takes & GLINT_TAKES_SHADER || (count ? !glint_pattern_numbers(*program, most, value) : !glint_program_constant(*program, value)))
        return;
    if (count && !means_the_same(field, value))
        return;
    memcpy((char *)desc + field->offset, value, (size_t)count * sizeof *value);
    if (field->set_offset)
        ((bool *)desc)[field->set_offset] = true;
    *program = NULL;
}

/// Normalises -0 to 0, so that both hash to the same key.
static void drop_signs_of_zeros(glint_material_desc *desc)
{
    for (const glint_object_field *f = glint_material_fields; f->name; f++)
        for (int i = 0; i < glint_field_numbers(f); i++)
            ((double *)(void *)((char *)desc + f->offset))[i] += 0.0;
}

/// Checks a description and replaces constant programs by their numbers.
static glint_status take(const glint_material_desc *desc, glint_material_desc *out, glint_error *error)
{
    *out = *desc;
    EACH_PROGRAM(f)
    {
        const glint_program *program = *program_at(desc, f);
        glint_status status = program ? check_program(f, program, error) : GLINT_OK;
        if (status)
            return status;
        if (program)
            fold_program(f, out);
    }
    drop_signs_of_zeros(out);
    const glint_status status = glint_fields_check(glint_material_fields, out, error);
    if (!status && !(out->roughness >= 0 && out->roughness <= 1)) // used even if unset, like specular
        return glint_fail(error, GLINT_ERR_INVALID, "roughness: number 0 .. 1 expected, got %.10g", out->roughness);
    return status ? status : glint_check_color("specular", out->specular, error);
}

glint_status glint_material_create(const glint_material_desc *given, glint_material **out, glint_error *error)
{
    GLINT_REFUSE_NULL(out, error);
    GLINT_TAKE_DESC(glint_material_desc, defaults());
    glint_material_desc taken;
    status = take(desc, &taken, error);
    if (status)
        return status;
    glint_material *material = malloc(sizeof *material);
    if (!material)
        return glint_fail_nomem(error);
    hold_programs(&taken);
    *material = (glint_material) { .references = 1, .desc = taken };
    *out = material;
    return GLINT_OK;
}

glint_status glint_material_set(glint_material *material, const glint_material_desc *given, glint_error *error)
{
    GLINT_REFUSE_NULL(material, error);
    GLINT_TAKE_DESC(glint_material_desc, defaults());
    glint_material_desc taken;
    status = take(desc, &taken, error);
    if (status)
        return status;
    hold_programs(&taken);
    release_programs(&material->desc);
    material->desc = taken;
    return GLINT_OK;
}

const glint_material_desc *glint_material_get(const glint_material *material)
{
    return material ? &material->desc : NULL;
}

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
    release_programs(&material->desc);
    free(material);
}

void glint_material_desc_resolve(glint_material_desc *desc)
{
    if (!desc)
        return;
    const double r = desc->ior < 1e300 ? (desc->ior - 1) / (desc->ior + 1) : 1;
    for (int c = 0; c < 3; c++) {
        if (!desc->has_ambient)
            desc->ambient[c] = desc->diffuse[c];
        if (!desc->has_specular && desc->model == GLINT_MODEL_COOK_TORRANCE)
            desc->specular[c] = 1;
        if (!desc->has_f0)
            desc->f0[c] = r * r;
        if (!desc->has_mirror)
            desc->mirror[c] = desc->fresnel || desc->model == GLINT_MODEL_COOK_TORRANCE;
    }
    if (!desc->has_roughness && desc->model != GLINT_MODEL_COOK_TORRANCE)
        desc->roughness = 0;
    desc->has_ambient = desc->has_specular = desc->has_f0 = desc->has_mirror = desc->has_roughness = true;
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

bool glint_material_has_facets(const glint_material_desc *desc)
{
    return desc->model == GLINT_MODEL_COOK_TORRANCE && !desc->program.shader;
}

bool glint_material_mirrors(const glint_material_desc *desc)
{
    const bool facets = glint_material_has_facets(desc);
    return (desc->program.mirror || (desc->has_mirror ? is_any(desc->mirror) : desc->fresnel || facets)) &&
           (!facets || glint_material_is_shiny(desc));
}

bool glint_material_is_rough(const glint_material_desc *desc)
{
    return glint_material_has_facets(desc) || desc->program.roughness || (desc->has_roughness && desc->roughness > 0);
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
