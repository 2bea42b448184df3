// The reference of soft_light, for one type of real; included by ref.c after ref/real.h: light, occlude and shade one
// after the other.

/// The results of light and occlude for each sample.
typedef struct NAME(soft_rows) {
    uint16_t lit[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS], unoccluded[GLINT_LIGHT_CHUNK][GLINT_TILE_GROUPS];
    float cosine[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES], attenuation[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
    float log2_specular[GLINT_LIGHT_CHUNK][GLINT_TILE_SAMPLES];
} NAME(soft_rows);

static void NAME(fill_rows)(const glint_soft_args *args, NAME(soft_rows) * rows)
{
    glint_light_args light = *args->light;
    for (uint32_t s = 0; s < light.sample_count; s++) {
        light.lit[s] = rows->lit[s];
        light.cosine[s] = rows->cosine[s];
        light.attenuation[s] = rows->attenuation[s];
        light.log2_specular[s] = rows->log2_specular[s];
    }
    NAME(light)(&light);
    if (!args->occlude)
        return;
    glint_occlude_args occlude = *args->occlude;
    for (uint32_t s = 0; s < light.sample_count; s++) {
        occlude.lit[s] = rows->lit[s];
        occlude.unoccluded[s] = rows->unoccluded[s];
    }
    NAME(occlude)(&occlude);
}

/// Sums the samples that reach lane i. Returns whether any sample does.
static bool NAME(sum_rows)(const glint_soft_args *args, const NAME(soft_rows) * rows, uint32_t i, float *diffuse,
                           float *specular)
{
    const glint_light_args *light = args->light;
    const glint_shade_material *material = &light->materials[light->material[i]];
    bool any = false;
    *diffuse = *specular = 0;
    for (uint32_t s = 0; s < light->sample_count; s++) {
        const uint16_t *reached = args->occlude ? rows->unoccluded[s] : rows->lit[s];
        if (!(reached[i / GLINT_GROUP] >> i % GLINT_GROUP & 1))
            continue;
        float w = light->attenuated ? rows->attenuation[s][i] : 1, cosine = rows->cosine[s][i];
        any = true;
        *diffuse += w * cosine;
        if (!light->highlights || !(rows->log2_specular[s][i] > GLINT_NO_SPECULAR))
            continue;
        float strength = highlight_strength(material->shininess, rows->log2_specular[s][i]);
        *specular += w * (material->lobe == GLINT_LOBE_POWER_COSINE ? strength * cosine : strength);
    }
    return any;
}

static bool NAME(soft_light)(const glint_soft_args *args)
{
    NAME(soft_rows) rows;
    NAME(fill_rows)(args, &rows);
    for (uint32_t g = 0; g < args->light->group_count; g++) {
        float diffuse[GLINT_GROUP], specular[GLINT_GROUP];
        unsigned reached = 0;
        for (uint32_t lane = 0; lane < GLINT_GROUP; lane++)
            reached |= (unsigned)NAME(sum_rows)(args, &rows, g * GLINT_GROUP + lane, &diffuse[lane], &specular[lane])
                       << lane;
        args->reached[g] = (uint16_t)reached;
        for (uint32_t lane = 0; reached && lane < GLINT_GROUP; lane++) {
            args->diffuse[g * GLINT_GROUP + lane] = diffuse[lane];
            if (args->light->highlights)
                args->specular[g * GLINT_GROUP + lane] = specular[lane];
        }
    }
    return true;
}
