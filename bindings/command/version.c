// glint --version; with --verbose also the parts of this build and its limits.
#include <lua.h>
#include <stdlib.h>
#include <string.h>

#include "bindings/command/cli.h"

static const char *const KERNELS[] = { "ref", "generic", "avx2", "avx512" };

// Prints the kernels that the build has and the machine can run. False: out of memory. The list is then incomplete.
static bool print_kernels(FILE *out)
{
    glint_renderer *renderer = NULL;
    glint_error error = { .message = "none" };
    fputs("kernels:", out);
    for (size_t i = 0; i < sizeof KERNELS / sizeof *KERNELS; i++) {
        glint_renderer_desc desc = glint_renderer_desc_default();
        desc.isa = KERNELS[i];
        desc.threads = 1;
        const glint_status status = glint_renderer_create(&desc, &renderer, NULL);
        if (status == GLINT_ERR_NOMEM)
            return false;
        if (status != GLINT_OK)
            continue;
        fprintf(out, " %s", KERNELS[i]);
        glint_renderer_destroy(renderer);
    }
    glint_renderer_desc desc = glint_renderer_desc_default();
    const glint_status status = glint_renderer_create(&desc, &renderer, &error);
    if (status == GLINT_OK) {
        fprintf(out, "; in use: %s, %d threads\n", glint_renderer_isa(renderer), glint_renderer_threads(renderer));
        glint_renderer_destroy(renderer);
    } else {
        fprintf(out, "; %s\n", error.message);
    }
    return status != GLINT_ERR_NOMEM;
}

int cli_version(const cli_options *options, cli_output *output)
{
    FILE *out = output->data;
    fputs("glint " GLINT_VERSION "\n", out);
    if (!options->verbose)
        return GLINTL_EXIT_DONE;
    fputs("libraries: " LUA_RELEASE, out);
    for (const char *const *library = glint_libraries(); *library; library++)
        fprintf(out, ", %s", *library);
    fprintf(out, "\nwrites: .png .svg%s .pfm .npy%s; deflates by %s (fast), %s (small)\n", glint_cairo_version() ? " .pdf" : "",
            glint_exr_library() ? " .exr" : "", glint_encoder_name(GLINT_ENCODE_FAST), glint_encoder_name(GLINT_ENCODE_SMALL));
#ifdef GLINT_HAVE_SECCOMP
    fputs("--untrusted: yes, by seccomp\n", out);
#else
    fputs("--untrusted: no, this build has no libseccomp\n", out);
#endif
    if (!print_kernels(out))
        return cli_report_error(output, 0, GLINTL_EXIT_FAILED, "out of memory");
    fprintf(
        out,
        "limits: %d pixels a side, 2147483647 a frame, 65536 samples a pixel, %d frames a job, 2^30 spheres a shape\n",
        GLINT_SIDE_MAX, GLINTL_FRAMES_MAX);
    return GLINTL_EXIT_DONE;
}
