// glint compare A B: how much two pictures differ. It uses idiff's exit codes.
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "bindings/command/cli.h"
#include "engine/glint_compare.h"

typedef enum verdict { SAME, WARN, DIFFER, SIZE, UNREADABLE } verdict;

static const char *const VERDICTS[] = { "same", "warn", "differ", "size", "file" };

static verdict judge(glint_status status, const glint_compare_result *result)
{
    if (status == GLINT_ERR_INVALID)
        return SIZE;
    if (status)
        return UNREADABLE;
    return result->failed ? DIFFER : result->warned ? WARN : SAME;
}

static void print_json(FILE *out, char **files, verdict found, const glint_compare_result *result, const char *message)
{
    glintL_json(out, "{\"event\":\"compare\",\"a\":%s,\"b\":%s,\"result\":%s", files[0], files[1], VERDICTS[found]);
    if (found >= SIZE) {
        glintL_json(out, ",\"message\":%s", message);
    } else {
        fprintf(out, ",\"width\":%d,\"height\":%d,\"channels\":%d", result->width, result->height, result->channels);
        glintL_json(out, ",\"mean_error\":%g,\"rms_error\":%g,\"peak_snr\":%g,\"max_error\":%g", result->mean_error,
                    result->rms_error, result->peak_snr, result->max_error);
        fprintf(out, ",\"max_at\":{\"x\":%d,\"y\":%d,\"channel\":%d}", result->max_x, result->max_y,
                result->max_channel);
        fprintf(out, ",\"failed\":%" PRIu64 ",\"warned\":%" PRIu64 ",\"pixels\":%" PRIu64, result->failed,
                result->warned, result->pixels);
    }
    fputs("}\n", out);
}

static void print_share(FILE *out, uint64_t count, uint64_t pixels, double threshold)
{
    if (count)
        fprintf(out, "  %" PRIu64 " pixels (%.3g%%) over %g\n", count, 100.0 * (double)count / (double)pixels,
                threshold);
}

static void print_for_people(FILE *out, char **files, const glint_compare_result *result,
                             const glint_compare_desc *desc, verdict found)
{
    static const char *const words[] = { "same", "nearly the same", "different" };
    glintL_put_text(out, files[0], strlen(files[0]));
    fputs(" and ", out);
    glintL_put_text(out, files[1], strlen(files[1]));
    fprintf(out, ": %s\n", words[found]);
    fprintf(out, "  mean error %g, RMS error %g, peak SNR %g dB\n", result->mean_error, result->rms_error,
            result->peak_snr);
    fprintf(out, "  max error %g", result->max_error);
    if (result->max_error > 0)
        fprintf(out, " at %d, %d, channel %d", result->max_x, result->max_y, result->max_channel);
    fputc('\n', out);
    print_share(out, result->failed, result->pixels, desc->fail);
    if (desc->warn != desc->fail) // equal limits would print the same line twice
        print_share(out, result->warned, result->pixels, desc->warn);
}

int cli_compare(cli_options *options, cli_output *output, glintL_run *run)
{
    (void)run;
    glint_compare_desc desc = { .fail = 1e-6, .warn = 1e-6 };
    glint_compare_result result = { 0 };
    glint_error error = { .message = "" };
    if (options->argument_count != 2)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "compare: two files expected");
    if (options->fail >= 0 && options->tolerance >= 0)
        return cli_report_error(output, 0, GLINTL_EXIT_USAGE, "--tolerance: the same limit as --fail, in steps of 8 bits; give one of them");
    desc.fail = options->fail >= 0 ? options->fail : desc.fail;
    if (options->tolerance >= 0)
        desc.fail = options->tolerance / 255 + 1e-9; // differences of 8-bit values are rounded
    desc.warn = options->warn >= 0 ? options->warn : desc.warn;
    char **files = options->arguments;
    verdict found = judge(glint_compare_files(files[0], files[1], &desc, &result, &error), &result);
    if (options->json)
        print_json(output->data, files, found, &result, error.message);
    if (found >= SIZE)
        cli_print_error(output, error.message);
    else if (!options->json && !options->quiet)
        print_for_people(output->data, files, &result, &desc, found);
    return (int)found;
}
