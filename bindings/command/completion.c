// glint completion bash|zsh|fish: completions for the shell, generated from the tables of commands and options.
#include <string.h>

#include "bindings/command/cli.h"

typedef enum argument { WORD, FILES, CHOICES } argument;

// Writes the completions of an option's value, separated by spaces. "": anything; CLI_SUGGEST_FILES: file names.
static void find_offers(const cli_option *option, char out[256])
{
    size_t used = 0;
    out[0] = '\0';
    if (!option->suggest) {
        cli_option_value(option, out);
        if (!strchr(out, '|'))
            out[0] = '\0';
        for (char *at = out; *at; at++)
            *at = *at == '|' ? ' ' : *at;
    } else if (strcmp(option->suggest, CLI_SUGGEST_PASSES) == 0) {
        for (int pass = GLINT_PASS_BEAUTY + 1; pass < GLINT_PASS_COUNT; pass++)
            used += (size_t)snprintf(out + used, 256 - used, "%s%s", used ? " " : "", glint_pass_name(pass));
    } else {
        snprintf(out, 256, "%s", option->suggest);
    }
}

static argument argument_of(const cli_option *option)
{
    char offers[256];
    find_offers(option, offers);
    return strcmp(offers, CLI_SUGGEST_FILES) == 0 ? FILES : *offers ? CHOICES : WORD;
}

static void print_choices(FILE *out, const cli_option *option)
{
    char offers[256];
    find_offers(option, offers);
    fputs(offers, out);
}

// Prints the names of all commands that accept the option; of all commands when it is NULL.
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
        if (!option->value || cli_option_may_lack(option))
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

// Prints help within single quotes. A ':' or bracket would end a part of the line.
static void print_zsh_help(FILE *out, const char *help)
{
    for (; *help; help++)
        fprintf(out, *help == '\'' ? "'\\%c'" : strchr(":[]", *help) ? "\\%c" : "%c", *help);
}

static void print_zsh_option(FILE *out, const cli_option *option)
{
    const char *repeats = option->repeats ? "*" : "";
    if (option->letter)
        fprintf(out, "      '%s'{-%c,--%s}'[", repeats, option->letter, option->name);
    else
        fprintf(out, "      '%s--%s[", repeats, option->name);
    print_zsh_help(out, option->help);
    fputs("]", out);
    if (option->value) {
        fprintf(out, "%s:%s:", cli_option_may_lack(option) ? ":" : "", option->name);
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
    if (option->value && !cli_option_may_lack(option))
        fputs(argument_of(option) == FILES ? " -r -F" : " -x", out);
    if (argument_of(option) == CHOICES) {
        fputs(" -a '", out);
        print_choices(out, option);
        fputs("'", out);
    }
    fputs(" -d '", out);
    for (const char *at = option->help; *at; at++)
        fprintf(out, *at == '\'' ? "\\%c" : "%c", *at);
    fputs("'\n", out);
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

int cli_completion(const cli_options *options, cli_output *output)
{
    static const struct {
        const char *name;
        void (*print)(FILE *out);
    } shells[] = { { "bash", print_bash }, { "zsh", print_zsh }, { "fish", print_fish } };
    char message[GLINTL_MESSAGE_SIZE] = "completion: a shell expected: bash, zsh or fish";
    if (options->script) {
        for (int i = 0; i < 3; i++)
            if (strcmp(options->script, shells[i].name) == 0) {
                shells[i].print(output->data);
                return GLINTL_EXIT_DONE;
            }
        snprintf(message, sizeof message, "completion: bash, zsh or fish expected, got '%.100s'", options->script);
    }
    return cli_report_error(output, 0, GLINTL_EXIT_USAGE, message);
}
