// The two streams of the command: data on stdout, lines for people on stderr.
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bindings/command/cli.h"

#define LINE_BUFFER 65536 // bytes: cli_end_line writes a line of data at once

static bool wants_color(void)
{
    const char *no_color = getenv("NO_COLOR"), *term = getenv("TERM");
    return isatty(STDERR_FILENO) && !(no_color && *no_color) && !(term && strcmp(term, "dumb") == 0);
}

bool cli_output_open(cli_output *output, const cli_options *options)
{
    memset(output, 0, sizeof *output);
    output->data = stdout;
    output->json = options->json;
    output->quiet = options->quiet;
    output->color = wants_color();
    output->start_ms = glintL_now_ms();
    if (!options->json)
        return true;
    fflush(stdout);
    int copy = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    output->data = copy >= 0 ? fdopen(copy, "w") : NULL;
    if (!output->data || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
        fprintf(stderr, "glint: stdout: %s\n", strerror(errno));
        return false;
    }
    setvbuf(stdout, NULL, _IOLBF, 0);
    setvbuf(output->data, NULL, _IOFBF, LINE_BUFFER);
    return true;
}

// Prints a message. Its further lines are indented, so that none looks like another message.
static void put_message(FILE *out, const char *message)
{
    for (const char *end; (end = strchr(message, '\n')); message = end + 1) {
        glintL_put_text(out, message, (size_t)(end - message));
        fputs(end[1] == ' ' || end[1] == '\t' ? "\n" : "\n  ", out);
    }
    glintL_put_text(out, message, strlen(message));
    fputc('\n', out);
}

static void print_line(cli_output *output, const char *color, const char *kind, const char *message)
{
    if (output->progress)
        cli_progress_clear(output->progress);
    char *line = NULL;
    size_t size = 0;
    FILE *made = open_memstream(&line, &size), *out = made ? made : stderr; // one write, so that lines stay whole
    fprintf(out, output->color ? "glint: %s%s\033[0m" : "glint: %.0s%s", color, kind);
    put_message(out, message);
    if (made && fclose(made) == 0)
        fwrite(line, 1, size, stderr);
    free(line);
}

void cli_print_error(cli_output *output, const char *message) { print_line(output, "\033[1;31m", "error: ", message); }

void cli_print_warning(cli_output *output, const char *message)
{
    print_line(output, "\033[33m", "warning: ", message);
}

int cli_output_close(cli_output *output)
{
    char message[GLINTL_MESSAGE_SIZE];
    errno = 0;
    bool failed = output->data_failed || ferror(output->data);
    if (failed && !output->data_failed) // the errno is lost; writing one more byte repeats the error
        fputc('\n', output->data);
    if ((fflush(output->data) != 0 || failed) && !output->data_failed) {
        output->data_failed = true;
        output->data_errno = errno;
    }
    if (output->data != stdout) {
        fflush(stdout);
        fclose(output->data);
    }
    output->data = NULL;
    if (!output->data_failed)
        return GLINTL_EXIT_DONE;
    snprintf(message, sizeof message, "stdout: %s", output->data_errno ? strerror(output->data_errno) : "write error");
    if (!output->failure_printed)
        cli_print_error(output, message);
    return output->data_errno == ENOSPC ? GLINTL_EXIT_LATER : GLINTL_EXIT_FAILED;
}
