/// Sixteen rays of 4 x 4 pixels: Phong's formula and the samples of pixels and lights. The including file defines
/// `trace` and `hidden`, which are inlined here.
#ifndef GLINT_BENCH_PACKET_LIGHT_H
#define GLINT_BENCH_PACKET_LIGHT_H

#include "tests/bench/packet.h"

/// Returns the nearest hits of rays from the eye. `dir` has unit length.
static inline packet_hit trace(const packet_scene *s, vec dir);
/// Returns the lanes of `mask` that have an occluder between the point and the light.
/// The light is at `distance` along `l`.
static inline vm hidden(const packet_scene *s, vec point, vec l, vf distance, vm mask);

typedef struct light_sum {
    vf diffuse, highlight; ///< sums of n.l and of (r.v)^shininess
} light_sum;

/// Adds the light from one point of a light.
static inline void add_light(const packet_scene *s, const packet_hit *hit, vec dir, vec light, vf shininess, vm glossy,
                             light_sum *sum)
{
    vec l = minus(light, hit->point);
    vf square = dot(l, l), inverse = inverse_sqrt(square);
    l = scaled(l, inverse);
    vf n_l = dot(hit->normal, l);
    vm lit = hit->mask & less(all(0), n_l);
    if (lit && s->options.shadows)
        lit &= (vm)~hidden(s, hit->point, l, square * inverse, lit);
    if (!lit)
        return;
    sum->diffuse = _mm512_mask_add_ps(sum->diffuse, lit, sum->diffuse, n_l);
    // r.v with r = 2 (n.l) n - l and v = -dir
    vf r_v = dot(l, dir) - (n_l + n_l) * dot(hit->normal, dir);
    vm shiny = lit & glossy & less(all(0), r_v);
    if (shiny)
        sum->highlight = _mm512_mask_add_ps(sum->highlight, shiny, sum->highlight, exp2_of(log2_of(r_v) * shininess));
}

static inline light_sum sum_lights(const packet_scene *s, const packet_hit *hit, vec dir, vm glossy)
{
    light_sum sum = { all(0), all(0) };
    vf shininess = look_up(s->shininess, hit->material);
    vec light = all3(s->light);
    if (!s->options.area) {
        add_light(s, hit, dir, light, shininess, glossy, &sum);
        return sum;
    }
    for (int k = 0; k < LIGHT_SAMPLES; k++) {
        const float *o = s->light_offset[k];
        vec at = { light.x + all(o[0]) * s->turn_cos - all(o[2]) * s->turn_sin, light.y + all(o[1]),
                   light.z + all(o[0]) * s->turn_sin + all(o[2]) * s->turn_cos };
        add_light(s, hit, dir, at, shininess, glossy, &sum);
    }
    return (light_sum) { sum.diffuse * all(1.0F / LIGHT_SAMPLES), sum.highlight * all(1.0F / LIGHT_SAMPLES) };
}

/// Adds the light of sixteen rays to `rgb`.
static inline void add_rays(const packet_scene *s, vec dir, vf rgb[3])
{
    packet_hit hit = trace(s, dir);
    const float *background = s->plain.background;
    if (!hit.mask) {
        for (int c = 0; c < 3; c++)
            rgb[c] += all(background[c]);
        return;
    }
    vf gloss = look_up(s->specular, hit.material);
    light_sum sum = sum_lights(s, &hit, dir, less(all(0), gloss));
    vf highlight = gloss * sum.highlight;
    for (int c = 0; c < 3; c++) {
        vf color = look_up(s->ambient[c], hit.material) + look_up(s->diffuse[c], hit.material) * sum.diffuse;
        rgb[c] += pick(hit.mask, color + highlight, all(background[c]));
    }
}

/// Renders a block. Lane k is the pixel (k % 4, k / 4) of the block.
static inline void render_block(const packet_scene *s, int x, int y, packet_band *band)
{
    vf rgb[3] = { all(0), all(0), all(0) };
    for (int k = 0; k < s->options.samples; k++) {
        vf across = all((float)x + s->sample[k][0]), along = all((float)y + s->sample[k][1]);
        vec dir = add_scaled(add_scaled(s->corner, s->right, across), s->down, along);
        add_rays(s, scaled(dir, inverse_sqrt(dot(dir, dir))), rgb);
    }
    for (int c = 0; c < 3; c++) {
        vf mean = rgb[c] * all(s->sample_weight);
        _mm_storeu_ps(&band->rgb[c][0][x], _mm512_extractf32x4_ps(mean, 0));
        _mm_storeu_ps(&band->rgb[c][1][x], _mm512_extractf32x4_ps(mean, 1));
        _mm_storeu_ps(&band->rgb[c][2][x], _mm512_extractf32x4_ps(mean, 2));
        _mm_storeu_ps(&band->rgb[c][3][x], _mm512_extractf32x4_ps(mean, 3));
    }
}

static void render_band(const packet_scene *s, int y, packet_band *band)
{
    for (int x = 0; x < BENCH_WIDTH; x += 4)
        render_block(s, x, y, band);
}

#endif
