/// The only file that reads the processor's flags. The Makefile defines GLINT_KERNEL_x for each instruction set that
/// it compiles.
#include "engine/render/stages/stages.h"

#include <stdlib.h>
#include <string.h>

const glint_stages *const glint_stages_built[] = {
#ifndef __wasm__ // a web page cannot select the reference, but every page would have to load it
    &glint_stages_ref,
#endif
#ifdef GLINT_KERNEL_generic
    &glint_stages_generic,
#endif
#ifdef GLINT_KERNEL_avx2
    &glint_stages_avx2,
#endif
#ifdef GLINT_KERNEL_avx512
    &glint_stages_avx512,
#endif
    NULL,
};

bool glint_stages_usable(const glint_stages *stages)
{
#ifdef __x86_64__
    __builtin_cpu_init();
    const bool bits =
        __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("popcnt");
    if (strcmp(stages->name, "avx2") == 0)
        return bits && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (strcmp(stages->name, "avx512") == 0)
        return bits && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("fma");
#endif
    return stages != NULL;
}

/// Returns whether an instruction set of this name exists on any machine.
static bool is_known(const char *name)
{
    static const char *const known[] = { "ref", "generic", "avx2", "avx512" };
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(known[i], name) == 0)
            return true;
    return false;
}

const glint_stages *glint_stages_select(const char *name, const char **requested, bool *unknown)
{
    const glint_stages *best = NULL;
    if (!name || !*name)
        name = getenv("GLINT_ISA");
    if (name && strcmp(name, "sse2") == 0) // its kernels are the generic ones
        name = "generic";
    *requested = name && *name ? name : NULL;
    *unknown = *requested && !is_known(*requested);
    for (const glint_stages *const *isa = glint_stages_built; *isa; isa++) {
        if (*requested && strcmp((*isa)->name, *requested) == 0)
            return glint_stages_usable(*isa) ? *isa : NULL;
        if (!*requested && glint_stages_usable(*isa))
            best = *isa;
    }
    return best;
}

const glint_stages *glint_stages_for(const glint_stages *stages, bool is_float)
{
#ifdef GLINT_NO_FLOAT
    if (is_float)
        return &glint_stages_ref;
#endif
    (void)is_float;
    return stages;
}
