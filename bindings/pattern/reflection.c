// material:evaluate for a material with programs: runs them at one point, and uses the results as the fields' values.
#include "bindings/pattern/pattern.h"
#include "engine/glint.h"

#include <math.h>
#include <string.h>

// Returns a number as a frame uses it: NaN and negative values become 0.
static double reflectance(double x) { return x > 0 ? fmin(x, 0x1p100) : 0; }

static glint_status run(const glint_program *program, const double inputs[GLINT_INPUT_COUNT], double *out, size_t count,
                        glint_error *error)
{
    double numbers[GLINT_PROGRAM_OUTPUTS_MAX] = { 0 };
    const glint_status status = glint_program_evaluate(program, inputs, numbers, error);
    const bool is_grey = glint_program_output_count(program) == 1;
    for (size_t i = 0; i < count && !status; i++)
        out[i] = reflectance(numbers[is_grey ? 0 : i]);
    return status;
}

static glint_status run_patterns(glint_material_desc *desc, const double inputs[GLINT_INPUT_COUNT], glint_error *error)
{
    glint_program *const shader = desc->program.shader;
    glint_status status = GLINT_OK;
    for (const glintL_field *f = glint_object_fields(GLINT_OBJECT_MATERIAL, NULL); f->name && !status; f++) {
        glint_program *program = f->program_offset ? *(glint_program **)(void *)((char *)desc + f->program_offset) : NULL;
        double *numbers = (double *)(void *)((char *)desc + f->offset);
        if (!program || program == shader || f->type == GLINT_TYPE_PROGRAM)
            continue;
        status = run(program, inputs, numbers, f->type == GLINT_TYPE_COLOR ? 3 : 1, error);
        if (f->type == GLINT_TYPE_NUMBER)
            *numbers = fmin(*numbers, f->high);
    }
    desc->program = (glint_material_programs) { .shader = shader };
    return status;
}

static void unit(const double v[3], double factor, double out[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        out[i] = v[i] / length * factor;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static glint_status run_shader(const glint_material_desc *desc, double inputs[GLINT_INPUT_COUNT], glint_reflection *out,
                               glint_error *error)
{
    double both[6] = { 0 };
    for (int i = 0; i < 3; i++) {
        inputs[GLINT_INPUT_LIGHT_R + i] = 1;
        inputs[GLINT_INPUT_KD_R + i] = desc->diffuse[i];
        inputs[GLINT_INPUT_KS_R + i] = desc->specular[i];
    }
    inputs[GLINT_INPUT_DISTANCE] = HUGE_VAL;
    inputs[GLINT_INPUT_SHININESS] = desc->shininess;
    glint_status status = GLINT_OK;
    if (dot(&inputs[GLINT_INPUT_N_X], &inputs[GLINT_INPUT_L_X]) > 0)
        status = run(desc->program.shader, inputs, both, 6, error);
    memcpy(out->diffuse, both, sizeof out->diffuse);
    memcpy(out->specular, both + 3, sizeof out->specular);
    return status;
}

glint_status glintL_evaluate_material(const glint_material *material, const glintL_geometry *at, glint_reflection *out,
                                      glint_error *error)
{
    static const glint_material_programs none;
    double inputs[GLINT_INPUT_COUNT] = { 0 };
    glint_material_desc desc = *glint_material_get(material);
    desc.struct_size = sizeof desc;
    glint_material *plain = NULL;
    glint_status status = glint_material_evaluate(material, at->normal, at->to_light, at->to_eye, out, error);
    if (status || memcmp(&desc.program, &none, sizeof none) == 0)
        return status;
    unit(at->normal, dot(at->normal, at->to_eye) < 0 ? -1 : 1, &inputs[GLINT_INPUT_N_X]);
    unit(at->to_light, 1, &inputs[GLINT_INPUT_L_X]);
    unit(at->to_eye, 1, &inputs[GLINT_INPUT_V_X]);
    memcpy(&inputs[GLINT_INPUT_P_X], at->p, sizeof at->p);
    memcpy(&inputs[GLINT_INPUT_WORLD_X], at->p, sizeof at->p);
    status = run_patterns(&desc, inputs, error);
    if (!status && desc.program.shader)
        return run_shader(&desc, inputs, out, error);
    if (!status)
        status = glint_material_create(&desc, &plain, error);
    if (!status)
        status = glint_material_evaluate(plain, at->normal, at->to_light, at->to_eye, out, error);
    glint_material_release(plain);
    return status;
}
