// The commands of the command line: a command is a row here.
#include <string.h>

#include "bindings/command/cli.h"

const cli_command_name cli_command_list[CLI_COMMAND_COUNT] = {
    { "render", CLI_RENDER, CLI_SCRIPT, CLI_RUN, cli_render, "SCRIPT [options]",
      "render the frames of a script; the word render is optional" },
    { "explain", CLI_EXPLAIN, CLI_SCRIPT, CLI_RUN, cli_explain, "SCRIPT [--frame N] [--programs] [--json]",
      "run the script and show what a frame needs, and which object needs it" },
    { "dump", CLI_DUMP, CLI_SCRIPT, CLI_RUN, cli_dump, "SCRIPT [-f N] [-o FILE.lua]",
      "write the scene of one frame as a script that renders the same picture" },
    { "describe", CLI_DESCRIBE, CLI_SCRIPT, CLI_RUN, cli_describe, "SCRIPT --json",
      "list the parameters of a script, for programs" },
    { "compare", CLI_COMPARE, CLI_FILES, CLI_SIGNALS, cli_compare, "A B [--fail X] [--warn X]",
      "compare two pictures; exit 0 same, 1 warning, 2 different, 3 other size, 4 unreadable file" },
    { "sheet", CLI_SHEET, CLI_FILES, CLI_SIGNALS, cli_sheet, "FILES -o SHEET",
      "make a contact sheet, .png, .svg, .pdf or .html, of finished frames" },
    { "assemble", CLI_ASSEMBLE, CLI_FILES, CLI_RUN, cli_assemble, "FILES -o FILM",
      "make a film of finished frames" },
    { "join", CLI_JOIN, CLI_FILES, CLI_SIGNALS, cli_join, "PARTS -o PICTURE",
      "join the parts that --region has rendered into one picture" },
    { "relight", CLI_RELIGHT, CLI_FILES, CLI_RUN, cli_relight, "FILE.exr -o PICTURE [--light NAME=VALUE]",
      "change the strength and colour of lights, using light passes; -o NAME.html makes a mixer page" },
    { "reproduce", CLI_REPRODUCE, CLI_FILE_SCRIPT, CLI_RUN, cli_reproduce, "FILE SCRIPT",
      "render a finished frame again; exit 0 same bytes, 3 same pixels, 4 another picture, 5 unusable file" },
    { "new", CLI_NEW, CLI_FILES, CLI_NOTHING, cli_new, "NAME",
      "make a folder with a scene to start from" },
    { "cost", CLI_COST, CLI_SCRIPT, CLI_RUN, cli_cost, "SCRIPT [--report DIR]",
      "measure what each setting costs in time, and its error" },
    { "watch", CLI_WATCH, CLI_SCRIPT, CLI_RUN, cli_watch, "SCRIPT [--http [PORT]]",
      "render after every save; show the picture in the terminal or on a page" },
    { "publish", CLI_PUBLISH, CLI_SCRIPT, CLI_RUN, cli_publish, "SCRIPT -o PAGE.html",
      "write a one-file page with the engine, the script and its controls" },
    { "help", CLI_HELP, CLI_FILES, CLI_NOTHING, cli_help, "[COMMAND]",
      "show what a command does, and its options" },
    { "completion", CLI_COMPLETION, CLI_SCRIPT, CLI_NOTHING, cli_completion, "bash|zsh|fish",
      "print the completion script of a shell; make install installs it" },
};

const cli_command_name *cli_find_command(const char *word, const char **near)
{
    *near = NULL;
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++) {
        if (strcmp(word, cli_command_list[i].name) == 0)
            return &cli_command_list[i];
        *near = glintL_nearer(word, *near, cli_command_list[i].name);
    }
    return NULL;
}

const cli_command_name *cli_command_row(cli_command command)
{
    const cli_command_name *row = cli_command_list;
    while (row->command != command)
        row++;
    return row;
}
