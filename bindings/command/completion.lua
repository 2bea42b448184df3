-- Prints completions for a shell (glint completion bash|zsh|fish).
local the = ...

local commands, options, passes

-- Returns the completions of an option's value, separated by spaces. "": anything; "/": file names.
local function offers_of(option)
  if option.suggest == "," then return table.concat(passes, " ", 2) end -- without beauty
  return option.suggest or (option.value:find("|", 1, true) and option.value:gsub("|", " ")) or ""
end

-- Returns the names of the commands that accept the option; of all commands if it is nil.
local function names_of(between, option)
  local out = {}
  for _, command in ipairs(commands) do
    if not option or option.commands & command.bit ~= 0 then out[#out + 1] = command.name end
  end
  return table.concat(out, between)
end

-- Returns a text for each command, from the texts of its options.
local function for_commands(first, last, text_of)
  local out = {}
  for _, command in ipairs(commands) do
    out[#out + 1] = first:format(command.name)
    for _, option in ipairs(options) do
      if option.commands & command.bit ~= 0 then out[#out + 1] = text_of(option) end
    end
    out[#out + 1] = last
  end
  return table.concat(out)
end

local function for_options(text_of)
  local out = {}
  for i, option in ipairs(options) do out[i] = text_of(option) end
  return table.concat(out)
end

local function fill(template, values)
  return (template:gsub("@(%u+)@", values))
end

-- ---- bash ----

local BASH <const> = [=[
# bash completion for glint, made by: glint completion bash
_glint() {
  local now=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=render options word
  COMPREPLY=()
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case $word in
    @CASES@) command=$word; break ;;
    -*) ;;
    *) break ;;
    esac
  done
  case $before in
@VALUES@  esac
  case $command in
@OPTIONS@  esac
  if [[ $now == -* ]]; then COMPREPLY=($(compgen -W "$options" -- "$now")); return; fi
  compopt -o filenames 2>/dev/null
  case $command in
    compare) COMPREPLY=($(compgen -f -X '!*.@(png|pfm)' -- "$now") $(compgen -d -- "$now")) ;;
    sheet | assemble) COMPREPLY=($(compgen -f -X '!*.png' -- "$now") $(compgen -d -- "$now")) ;;
    reproduce) COMPREPLY=($(compgen -f -X '!*.@(png|lua)' -- "$now") $(compgen -d -- "$now")) ;;
    new) ;;
    completion) COMPREPLY=($(compgen -W "bash zsh fish" -- "$now")) ;;
    *) COMPREPLY=($(compgen -f -X '!*.lua' -- "$now") $(compgen -d -- "$now")) ;;
  esac
  if [[ $COMP_CWORD -eq 1 ]]; then COMPREPLY+=($(compgen -W "@COMMANDS@" -- "$now")); fi
}
shopt -s extglob
complete -F _glint glint
]=]

local function bash_value(option)
  if not option.takes_value or option.may_lack then return "" end
  local offers, reply = offers_of(option), ""
  if offers == "/" then
    reply = 'compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- "$now")); '
  elseif offers ~= "" then
    reply = 'COMPREPLY=($(compgen -W "' .. offers .. '" -- "$now")); '
  end
  return ("    --%s%s) %sreturn ;;\n"):format(option.name, option.letter ~= "" and " | -" .. option.letter or "", reply)
end

local function bash()
  return fill(BASH, {
    CASES = names_of " | ", VALUES = for_options(bash_value), COMMANDS = names_of " ",
    OPTIONS = for_commands('    %s) options="', '" ;;\n', function(option) return "--" .. option.name .. " " end),
  })
end

-- ---- zsh ----

local ZSH <const> = [=[
#compdef glint
# zsh completion for glint, made by: glint completion zsh
_glint() {
  local command=render
  local -a specs
  case ${words[2]} in
    @CASES@) (( CURRENT > 2 )) && { command=${words[2]}; shift words; (( CURRENT-- )) } ;;
  esac
  case $command in
@OPTIONS@  esac
  case $command in
    compare) specs+=('*:picture:_files -g "*.(png|pfm)"') ;;
    sheet|assemble) specs+=('*:picture:_files -g "*.png"') ;;
    reproduce) specs+=('1:picture:_files -g "*.png"' '2:script:_files -g "*.lua"') ;;
    new) specs+=('1:name:') ;;
    completion) specs+=('1:shell:(bash zsh fish)') ;;
    *) specs+=('1:script:_glint_script') ;;
  esac
  _arguments -s $specs
}
_glint_script() {
  _files -g "*.lua"
  (( CURRENT == 2 )) && [[ ${words[1]} == glint ]] && compadd @COMMANDS@
}
_glint "$@"
]=]

local function zsh_option(option)
  local repeats = option.repeats and "*" or ""
  local head = option.letter ~= "" and ("'%s'{-%s,--%s}'["):format(repeats, option.letter, option.name)
    or ("'%s--%s["):format(repeats, option.name)
  -- The help is within single quotes. A ':' or bracket would end a part of the line.
  local help = option.help:gsub("[':%[%]]", function(mark) return mark == "'" and "'\\''" or "\\" .. mark end)
  local offers, value = offers_of(option), ""
  if option.takes_value then
    value = (option.may_lack and ":" or "") .. ":" .. option.name .. ":"
      .. (offers == "/" and "_files" or offers ~= "" and "(" .. offers .. ")" or "")
  end
  return "      " .. head .. help .. "]" .. value .. "'\n"
end

local function zsh()
  return fill(ZSH, {
    CASES = names_of "|", COMMANDS = names_of " ",
    OPTIONS = for_commands("    %s) specs=(\n", "    ) ;;\n", zsh_option),
  })
end

-- ---- fish ----

local FISH <const> = [=[
# fish completion for glint, made by: glint completion fish
function __glint_is # whether the command line is one of these commands; render needs no word
    set -l command render
    for word in (commandline -opc)[2..-1]
        switch $word
            case @COMMANDS@
                set command $word
                break
            case '-*'
            case '*'
                break
        end
    end
    contains $command $argv
end
complete -c glint -f
@HELP@complete -c glint -n 'not __glint_is compare sheet assemble new completion' -k -a '(__fish_complete_suffix .lua)'
complete -c glint -n '__glint_is compare sheet assemble reproduce' -F
complete -c glint -n '__glint_is completion' -a 'bash zsh fish'
@OPTIONS@]=]

local function fish_option(option)
  local offers = offers_of(option)
  local value = option.takes_value and not option.may_lack and (offers == "/" and " -r -F" or " -x") or ""
  return ("complete -c glint -n '__glint_is %s' -l %s%s%s%s -d '%s'\n"):format(names_of(" ", option), option.name,
    option.letter ~= "" and " -s " .. option.letter or "", value,
    offers ~= "/" and offers ~= "" and " -a '" .. offers .. "'" or "", (option.help:gsub("'", "\\'")))
end

local function fish()
  local help, form = {}, "complete -c glint -n 'test (count (commandline -opc)) -eq 1' -a %s -d '%s'\n"
  for i, command in ipairs(commands) do help[i] = form:format(command.name, command.help) end
  return fill(FISH, { COMMANDS = names_of " ", HELP = table.concat(help), OPTIONS = for_options(fish_option) })
end

-- ---- The command ----

local SHELLS <const> = { bash = bash, zsh = zsh, fish = fish }

function the.run(my)
  local print_shell = SHELLS[my.script]
  if not my.script then my.fail(2, "a shell expected: bash, zsh or fish") end
  if not print_shell then my.fail(2, "bash, zsh or fish expected, got '" .. my.script .. "'") end
  commands, options, passes = my.tables()
  my.print(print_shell())
end
