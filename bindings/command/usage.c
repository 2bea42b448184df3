// glint --help, generated from the tables of commands and options.
#include <string.h>

#include "bindings/command/cli.h"

#define COLUMN 36 // column of the help texts
#define LINE 100 // their last column

static void print_words(FILE *out, int *at, const char *words)
{
    while (*words) {
        int length = (int)strcspn(words, " ");
        if (*at > COLUMN && *at + 1 + length > LINE) {
            fprintf(out, "\n%*s", COLUMN, "");
            *at = COLUMN;
        }
        *at += fprintf(out, "%s%.*s", *at > COLUMN ? " " : "", length, words);
        words += length + strspn(words + length, " ");
    }
}

// Prints a line of --help: the option, then its help, on the same line or below a long option.
static void print_line(FILE *out, const char *head, const char *help, bool lists_passes)
{
    int at = fprintf(out, "  %s", head);
    at += fprintf(out, at < COLUMN ? "%*s" : "\n%*s", at < COLUMN ? COLUMN - at : COLUMN, "");
    at = COLUMN;
    print_words(out, &at, help);
    for (int pass = 0; pass < GLINT_PASS_COUNT && lists_passes; pass++) {
        char name[32];
        snprintf(name, sizeof name, "%s,", glint_pass_name(pass));
        print_words(out, &at, name);
    }
    if (lists_passes)
        print_words(out, &at, "d:NAME, light:NAME, or all");
    fputc('\n', out);
}

static void print_option(FILE *out, const cli_option *option)
{
    char head[CLI_VALUE_SIZE + 32], value[CLI_VALUE_SIZE], letter[8] = "";
    cli_option_value(option, value);
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(head, sizeof head, "%s--%s%s%s", letter, option->name, *value ? " " : "", value);
    print_line(out, head, option->help, option->suggest && strcmp(option->suggest, CLI_SUGGEST_PASSES) == 0);
}

// Prints the options that one of the commands accepts, below their headings.
static void print_options(FILE *out, unsigned commands)
{
    const char *group = NULL;
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++) {
        const cli_option *option = &cli_option_list[i];
        group = option->group ? option->group : group;
        if (!(option->commands & commands))
            continue;
        if (group)
            fprintf(out, "\n%s:\n", group);
        group = NULL;
        print_option(out, option);
    }
}

static void print_usage(FILE *out)
{
    char head[128];
    fputs("usage: glint [render] SCRIPT [options]\n"
          "       glint SCRIPT --help         the script's parameters\n"
          "       glint help COMMAND          a command and its options\n\ncommands:\n",
          out);
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++) {
        snprintf(head, sizeof head, "%s %s", cli_command_list[i].name, cli_command_list[i].synopsis);
        print_line(out, head, cli_command_list[i].help, false);
    }
    print_options(out, ~0u);
    fputs("\nArguments after -- become the script's `arg`. The command line overrides the script.\nExit: 0 done, 1 a "
          "frame failed, 2 usage or script error, 75 disk full (try later), 130 and 143 by signal.\n",
          out);
}

static void print_command(FILE *out, const cli_command_name *command)
{
    fprintf(out, "usage: glint %s %s\n\n%s\n", command->name, command->synopsis, command->help);
    print_options(out, command->command);
    fputs("\nSee man glint for the full manual.\n", out);
}

static int refuse(cli_output *output, const char *format, const char *word, const char *near)
{
    char message[GLINTL_MESSAGE_SIZE];
    snprintf(message, sizeof message, format, word, near);
    return cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
}

int cli_help(const cli_options *options, cli_output *output)
{
    const char *near = NULL;
    const cli_command_name *command = NULL;
    const bool is_named = options->command == CLI_HELP && options->argument_count > 0;
    if (is_named && options->argument_count > 1)
        return refuse(output, "help: expected one command, got also '%.200s'%s", options->arguments[1], "");
    if (is_named)
        command = cli_find_command(options->arguments[0], &near);
    if (is_named && !command && near)
        return refuse(output, "help: %.200s: no such command; did you mean '%s'?", options->arguments[0], near);
    if (is_named && !command)
        return refuse(output, "help: %.200s: no such command; glint help lists them%s", options->arguments[0], "");
    for (size_t i = 0; i < CLI_COMMAND_COUNT && !is_named && options->has_command; i++)
        if (cli_command_list[i].command == options->command && options->command != CLI_HELP)
            command = &cli_command_list[i];
    if (command)
        print_command(output->data, command);
    else
        print_usage(output->data);
    return GLINTL_EXIT_DONE;
}
