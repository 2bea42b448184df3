// glint completion bash|zsh|fish: what the shell completes, made from the tables of commands and options.
#include <string.h>

#include "bindings/command/cli.h"

typedef enum argument { WORD, FILES, CHOICES } argument;

// What the option table does not say: a line for people, and how to complete the text.
static const struct hint {
    const char *name, *help, *choices; // choices: of the text, separated by blanks; NULL: those of the field, or none
    bool is_file;
} hints[] = {
    { "frames", "frames to render: 1-3,5,7-20:2,90-", NULL, false },
    { "start", "first frame", NULL, false },
    { "end", "last frame", NULL, false },
    { "jump", "step from frame to frame", NULL, false },
    { "shard", "K/N: the K-th of N parts", NULL, false },
    { "frame", "frame to look at", NULL, false },
    { "output", "pattern of the files, a film, a sheet, or none", NULL, true },
    { "fps", "frames a second of a film", NULL, false },
    { "apng", "a .png is a film", NULL, false },
    { "columns", "pictures in a row of the sheet", NULL, false },
    { "label", "TEXT under each picture, with {name}, {file}, {frame}", NULL, false },
    { "title", "TEXT above the sheet", NULL, false },
    { "difference", "N: also the difference from the N-th picture", NULL, false },
    { "gain", "X: times the difference", NULL, false },
    { "set", "NAME=VALUE: a parameter of the script", NULL, false },
    { "sweep", "NAME=A:B:N: N values of a parameter", NULL, false },
    { "size", "WxH: pixels across and down", "640x360 1280x720 1920x1080 3840x2160", false },
    { "samples", "samples a pixel", NULL, false },
    { "adaptive", "all samples only where neighbours differ by more", "0.3 0.1 0.03 0.01", false },
    { "precision", "what decides hits and shadows", NULL, false },
    { "visibility", "how it is found what the eye sees", NULL, false },
    { "bits", "of a channel", "8 16", false },
    { "transfer", "from light to codes", NULL, false },
    { "rounding", "of codes", NULL, false },
    { "tone", "curve", NULL, false },
    { "exposure", "stops brighter or darker", NULL, false },
    { "alpha", "transparent background", NULL, false },
    { "outline", "lines where objects end or have an edge", NULL, false },
    { "passes", "also write these",
      "background ambient diffuse specular indirect mirror transmission depth normal object_id alpha "
      "outline refined",
      false },
    { "encode", "fast to write or small on disk", NULL, false },
    { "seed", "another sample pattern", NULL, false },
    { "threads", "worker threads", NULL, false },
    { "no-reuse", "keep nothing from frame to frame", NULL, false },
    { "reuse-memory", "SIZE: what may be kept, 512M, 4G", NULL, false },
    { "force", "render finished frames, too", NULL, false },
    { "repeat", "render each frame N times", NULL, false },
    { "quick", "fewer runs of each setting", NULL, false },
    { "budget", "SECONDS the study may take", NULL, false },
    { "report", "DIR of the page with the plot", NULL, true },
    { "knobs", "LIST: these only", NULL, false },
    { "dialect", "what the script is written in", "gr", false },
    { "gr-order", "of transforms: the last acts first, or the first", "post pre", false },
    { "gr-pixel", "where in its pixel a ray passes", "0 0.5", false },
    { "gr-specular", "how highlights fall off", "phong blinn", false },
    { "gr-background", "R,G,B from 0 to 1, or #rrggbb", NULL, false },
    { "json", "events on stdout, one a line", NULL, false },
    { "quiet", "no report of frames", NULL, false },
    { "warnings", "what a warning does", "show error none", false },
    { "http", "also serve a page; on PORT", NULL, false },
    { "terminal", "how to draw", "kitty sixel blocks text", false },
    { "untrusted", "the script gets a process behind walls; SECONDS", NULL, false },
    { "fail", "threshold of failure", NULL, false },
    { "warn", "threshold of a warning", NULL, false },
    { "help", "help, with a script its parameters", NULL, false },
    { "version", "print the version", NULL, false },
};
#define HINT_COUNT (sizeof hints / sizeof *hints)

static const struct hint *find_hint(const char *name)
{
    for (size_t i = 0; i < HINT_COUNT; i++)
        if (strcmp(hints[i].name, name) == 0)
            return &hints[i];
    return NULL;
}

static argument argument_of(const cli_option *option)
{
    int field = glintL_render_find(option->name);
    if (find_hint(option->name)->is_file)
        return FILES;
    return find_hint(option->name)->choices || (field >= 0 && glintL_render_choices(field)) ? CHOICES : WORD;
}

// The choices of an option, separated by blanks.
static void print_choices(FILE *out, const cli_option *option)
{
    const struct hint *hint = find_hint(option->name);
    const char *const *names = hint->choices ? NULL : glintL_render_choices(glintL_render_find(option->name));
    fputs(hint->choices ? hint->choices : "", out);
    for (int i = 0; names && names[i]; i++)
        fprintf(out, "%s%s", i ? " " : "", names[i]);
}

// The names of all commands that know the option; of all commands when it is NULL.
static void print_commands(FILE *out, const cli_option *option, const char *between)
{
    bool first = true;
    for (size_t i = 0; i < CLI_COMMAND_COUNT; i++) {
        if (option && !(option->commands & cli_command_list[i].command))
            continue;
        fprintf(out, "%s%s", first ? "" : between, cli_command_list[i].name);
        first = false;
    }
}

// ---- bash ----

static void print_bash_options(FILE *out)
{
    for (size_t c = 0; c < CLI_COMMAND_COUNT; c++) {
        fprintf(out, "    %s) options=\"", cli_command_list[c].name);
        for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
            if (cli_option_list[i].commands & cli_command_list[c].command)
                fprintf(out, "--%s ", cli_option_list[i].name);
        fputs("\" ;;\n", out);
    }
}

static void print_bash_texts(FILE *out)
{
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++) {
        const cli_option *option = &cli_option_list[i];
        if (option->has_text != true)
            continue;
        fprintf(out, "    --%s", option->name);
        if (option->letter)
            fprintf(out, " | -%c", option->letter);
        fputs(") ", out);
        if (argument_of(option) == FILES) {
            fputs("compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- \"$now\")); ", out);
        } else if (argument_of(option) == CHOICES) {
            fputs("COMPREPLY=($(compgen -W \"", out);
            print_choices(out, option);
            fputs("\" -- \"$now\")); ", out);
        }
        fputs("return ;;\n", out);
    }
}

static void print_bash(FILE *out)
{
    fputs("# bash completion for glint, made by: glint completion bash\n"
          "_glint() {\n"
          "  local now=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=render options word\n"
          "  COMPREPLY=()\n"
          "  for word in \"${COMP_WORDS[@]:1:COMP_CWORD-1}\"; do\n"
          "    case $word in\n    ",
          out);
    print_commands(out, NULL, " | ");
    fputs(") command=$word; break ;;\n    -*) ;;\n    *) break ;;\n    esac\n  done\n  case $before in\n", out);
    print_bash_texts(out);
    fputs("  esac\n  case $command in\n", out);
    print_bash_options(out);
    fputs("  esac\n"
          "  if [[ $now == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$now\")); return; fi\n"
          "  compopt -o filenames 2>/dev/null\n"
          "  case $command in\n"
          "    compare) COMPREPLY=($(compgen -f -X '!*.@(png|pfm)' -- \"$now\") $(compgen -d -- \"$now\")) ;;\n"
          "    sheet | assemble) COMPREPLY=($(compgen -f -X '!*.png' -- \"$now\") $(compgen -d -- \"$now\")) ;;\n"
          "    reproduce) COMPREPLY=($(compgen -f -X '!*.@(png|lua)' -- \"$now\") $(compgen -d -- \"$now\")) ;;\n"
          "    new) ;;\n"
          "    completion) COMPREPLY=($(compgen -W \"bash zsh fish\" -- \"$now\")) ;;\n"
          "    *) COMPREPLY=($(compgen -f -X '!*.lua' -- \"$now\") $(compgen -d -- \"$now\")) ;;\n"
          "  esac\n"
          "  if [[ $COMP_CWORD -eq 1 ]]; then COMPREPLY+=($(compgen -W \"",
          out);
    print_commands(out, NULL, " ");
    fputs("\" -- \"$now\")); fi\n}\nshopt -s extglob\ncomplete -F _glint glint\n", out);
}

// ---- zsh ----

// Within single quotes; a ':' or a bracket would end a part of the line.
static void print_zsh_help(FILE *out, const char *help)
{
    for (; *help; help++)
        fprintf(out, strchr(":[]", *help) ? "\\%c" : "%c", *help);
}

static void print_zsh_option(FILE *out, const cli_option *option)
{
    const char *repeats = strcmp(option->name, "set") == 0 || strcmp(option->name, "sweep") == 0 ? "*" : "";
    if (option->letter)
        fprintf(out, "      '%s'{-%c,--%s}'[", repeats, option->letter, option->name);
    else
        fprintf(out, "      '%s--%s[", repeats, option->name);
    print_zsh_help(out, find_hint(option->name)->help);
    fputs("]", out);
    if (option->has_text) {
        fprintf(out, "%s:%s:", option->has_text == CLI_MAY_HAVE_NUMBER ? ":" : "", option->name);
        if (argument_of(option) == FILES)
            fputs("_files", out);
        if (argument_of(option) == CHOICES) {
            fputs("(", out);
            print_choices(out, option);
            fputs(")", out);
        }
    }
    fputs("'\n", out);
}

static void print_zsh(FILE *out)
{
    fputs("#compdef glint\n# zsh completion for glint, made by: glint completion zsh\n"
          "_glint() {\n  local command=render\n  local -a specs\n  case ${words[2]} in\n    ",
          out);
    print_commands(out, NULL, "|");
    fputs(") (( CURRENT > 2 )) && { command=${words[2]}; shift words; (( CURRENT-- )) } ;;\n  esac\n"
          "  case $command in\n",
          out);
    for (size_t c = 0; c < CLI_COMMAND_COUNT; c++) {
        fprintf(out, "    %s) specs=(\n", cli_command_list[c].name);
        for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
            if (cli_option_list[i].commands & cli_command_list[c].command)
                print_zsh_option(out, &cli_option_list[i]);
        fputs("    ) ;;\n", out);
    }
    fputs("  esac\n"
          "  case $command in\n"
          "    compare) specs+=('*:picture:_files -g \"*.(png|pfm)\"') ;;\n"
          "    sheet|assemble) specs+=('*:picture:_files -g \"*.png\"') ;;\n"
          "    reproduce) specs+=('1:picture:_files -g \"*.png\"' '2:script:_files -g \"*.lua\"') ;;\n"
          "    new) specs+=('1:name:') ;;\n"
          "    completion) specs+=('1:shell:(bash zsh fish)') ;;\n"
          "    *) specs+=('1:script:_glint_script') ;;\n"
          "  esac\n"
          "  _arguments -s $specs\n"
          "}\n"
          "_glint_script() {\n  _files -g \"*.lua\"\n  (( CURRENT == 2 )) && [[ ${words[1]} == glint ]] && compadd ",
          out);
    print_commands(out, NULL, " ");
    fputs("\n}\n_glint \"$@\"\n", out);
}

// ---- fish ----

static void print_fish_option(FILE *out, const cli_option *option)
{
    fputs("complete -c glint -n '__glint_is ", out);
    print_commands(out, option, " ");
    fprintf(out, "' -l %s", option->name);
    if (option->letter)
        fprintf(out, " -s %c", option->letter);
    if (option->has_text == true)
        fputs(argument_of(option) == FILES ? " -r -F" : " -x", out);
    if (argument_of(option) == CHOICES) {
        fputs(" -a '", out);
        print_choices(out, option);
        fputs("'", out);
    }
    fprintf(out, " -d '%s'\n", find_hint(option->name)->help);
}

static void print_fish(FILE *out)
{
    fputs("# fish completion for glint, made by: glint completion fish\n"
          "function __glint_is # whether the command line is one of these commands; render needs no word\n"
          "    set -l command render\n"
          "    for word in (commandline -opc)[2..-1]\n"
          "        switch $word\n"
          "            case ",
          out);
    print_commands(out, NULL, " ");
    fputs("\n                set command $word\n                break\n"
          "            case '-*'\n            case '*'\n                break\n        end\n    end\n"
          "    contains $command $argv\nend\n"
          "complete -c glint -f\n",
          out);
    for (size_t c = 0; c < CLI_COMMAND_COUNT; c++)
        fprintf(out, "complete -c glint -n 'test (count (commandline -opc)) -eq 1' -a %s -d '%s'\n",
                cli_command_list[c].name, cli_command_list[c].help);
    fputs("complete -c glint -n 'not __glint_is compare sheet assemble new completion' -k"
          " -a '(__fish_complete_suffix .lua)'\n"
          "complete -c glint -n '__glint_is compare sheet assemble reproduce' -F\n"
          "complete -c glint -n '__glint_is completion' -a 'bash zsh fish'\n",
          out);
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        print_fish_option(out, &cli_option_list[i]);
}

// ---- The command ----

// Every option has its hint, and every hint its option. False: `message` names the one that has not.
static bool check_hints(char message[GLINTL_MESSAGE_SIZE])
{
    for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
        if (!find_hint(cli_option_list[i].name)) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "completion: bindings/command/completion.c does not know --%s",
                     cli_option_list[i].name);
            return false;
        }
    for (size_t h = 0; h < HINT_COUNT; h++) {
        bool known = false;
        for (size_t i = 0; i < CLI_OPTION_COUNT; i++)
            known = known || strcmp(cli_option_list[i].name, hints[h].name) == 0;
        if (!known) {
            snprintf(message, GLINTL_MESSAGE_SIZE, "completion: there is no option --%s", hints[h].name);
            return false;
        }
    }
    return true;
}

int cli_completion(const cli_options *options, cli_output *output)
{
    static const struct {
        const char *name;
        void (*print)(FILE *out);
    } shells[] = { { "bash", print_bash }, { "zsh", print_zsh }, { "fish", print_fish } };
    char message[GLINTL_MESSAGE_SIZE] = "completion: a shell expected: bash, zsh or fish";
    if (options->script && check_hints(message)) {
        for (int i = 0; i < 3; i++)
            if (strcmp(options->script, shells[i].name) == 0) {
                shells[i].print(output->data);
                return GLINTL_EXIT_DONE;
            }
        snprintf(message, sizeof message, "completion: bash, zsh or fish expected, got '%.100s'", options->script);
    }
    cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
    return GLINTL_EXIT_USAGE;
}
