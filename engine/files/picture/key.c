/// The keys of pictures: hashes of everything that the bytes of a file depend on.
#include "engine/base/hash.h"
#include "engine/glint_files.h"
#include "engine/glint_inspect.h"

static glint_key key_of(const glint_plan *plan, const glint_write_desc *desc)
{
    // all derivatives share one number, and so do all light passes
    const int pass = desc->pass < GLINT_PASS_DERIVATIVE ? desc->pass :
                         desc->pass < GLINT_PASS_LIGHT ? GLINT_PASS_DERIVATIVE : GLINT_PASS_LIGHT;
    const int options[] = { pass,                desc->tone.curve, desc->tone.transfer,
                            desc->tone.rounding, desc->tone.bits,  desc->encode };
    uint64_t half[2];
    glint_plan_key(plan, half);
    glint_key key = glint_key_add((glint_key) { half[0], half[1] }, options, sizeof options);
    key = glint_key_add(key, &desc->tone.exposure, sizeof desc->tone.exposure);
    if (desc->tone.dither)
        key = glint_key_add_string(key, "dither");
    half[0] = key.high;
    half[1] = key.low;
    glint_plan_add_pass_key(plan, desc->pass, half);
    key = (glint_key) { half[0], half[1] };
    const bool scaled = desc->pass == GLINT_PASS_DEPTH || (desc->pass >= GLINT_PASS_DERIVATIVE && desc->pass < GLINT_PASS_LIGHT);
    if (desc->colormap && scaled)
        key = glint_key_add(key, &desc->colormap, sizeof desc->colormap);
    if (desc->range[0] != desc->range[1] && scaled)
        key = glint_key_add(key, desc->range, sizeof desc->range);
    if (desc->dpi > 0)
        key = glint_key_add(key, &desc->dpi, sizeof desc->dpi);
    key = glint_key_add_string(key, GLINT_VERSION);
    return glint_key_add_string(key, glint_encoder_name(desc->encode));
}

void glint_whole_key(const glint_plan *plan, const glint_write_desc *desc, char hex[33])
{
    if (!plan || !desc || !hex)
        return;
    glint_key_hex(key_of(plan, desc), hex);
}

void glint_frame_key(const glint_plan *plan, const glint_write_desc *desc, char hex[33])
{
    if (!plan || !desc || !hex)
        return;
    const int64_t *r = glint_plan_render_desc(plan)->region;
    const double region[4] = { r[0], r[1], r[2], r[3] }; // as in the files of earlier versions
    glint_key key = key_of(plan, desc);
    if (r[2] > 0)
        key = glint_key_add(key, region, sizeof region);
    glint_key_hex(key, hex);
}
