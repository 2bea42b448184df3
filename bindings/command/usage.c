// glint --help, made from the tables of commands and options.
#include <string.h>

#include "bindings/command/cli.h"

#define COLUMN 36 // the helps begin here
#define LINE 100 // and end before this

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

// A line of --help: what is written, then what it does, beside it or where it is long below it.
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
        print_words(out, &at, "d:NAME");
    fputc('\n', out);
}

static void print_option(FILE *out, const cli_option *option)
{
    char head[CLI_VALUE_SIZE + 32], value[CLI_VALUE_SIZE], letter[8] = "";
    cli_option_value(option, value);
    if (option->letter)
        snprintf(letter, sizeof letter, "-%c, ", option->letter);
    snprintf(head, sizeof head, "%s--%s%s%s", letter, option->name, *value ? " " : "", value);
    if (option->group)
        fprintf(out, "\n%s:\n", option->group);
    print_line(out, head, option->help, option->suggest && strcmp(option->suggest, CLI_SUGGEST_PASSES) == 0);
}

void cli_print_usage(FILE *out)
{
    char head[128];
    fputs("usage: glint [render] SCRIPT [options]\n"
          "       glint SCRIPT --help         the script's parameters\n\ncommands:\n",
          out);
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++) {
        snprintf(head, sizeof head, "%s %s", cli_command_list[i].name, cli_command_list[i].synopsis);
        print_line(out, head, cli_command_list[i].help, false);
    }
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        print_option(out, &cli_option_list[i]);
    fputs("\nWords after -- are the script's `arg`. What the command line says beats what the script says.\n"
          "Exit: 0 done, 1 a frame failed, 2 usage or script error, 75 disk full (try later), 130 and 143 by signal.\n",
          out);
}
