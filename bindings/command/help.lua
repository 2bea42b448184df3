-- Prints the help of glint or of one command (glint help, glint --help).
local the = ...

local COLUMN <const>, LINE <const> = 36, 100 -- the column of the help texts, and their last column
local MARGIN <const> = "\n" .. (" "):rep(COLUMN)

-- Returns a line: the head, then the words, on the same line or below a long head.
local function line_of(head, words)
  local out, at = "  " .. head, COLUMN
  out = out .. (#out < COLUMN and (" "):rep(COLUMN - #out) or MARGIN)
  for word in words:gmatch "[^ ]+" do
    if at > COLUMN and at + 1 + #word > LINE then
      out, at = out .. MARGIN, COLUMN
    end
    out, at = out .. (at > COLUMN and " " or "") .. word, at + (at > COLUMN and 1 or 0) + #word
  end
  return out .. "\n"
end

local function line_of_option(option, passes)
  local head = (option.letter ~= "" and "-" .. option.letter .. ", " or "") .. "--" .. option.name
    .. (option.value ~= "" and " " .. option.value or "")
  local list = option.suggest == "," and " " .. table.concat(passes, ", ") .. ", d:NAME, light:NAME, or all" or ""
  return line_of(head, option.help .. list)
end

-- Returns the options that one of the commands accepts, below their headings.
local function list_options(commands, options, passes)
  local out, group = {}, nil
  for _, option in ipairs(options) do
    group = option.group or group
    if option.commands & commands ~= 0 then
      if group then out[#out + 1] = "\n" .. group .. ":\n" end
      group = nil
      out[#out + 1] = line_of_option(option, passes)
    end
  end
  return table.concat(out)
end

local function usage(commands, options, passes)
  local out = {}
  for i, command in ipairs(commands) do out[i] = line_of(command.name .. " " .. command.synopsis, command.help) end
  return [[
usage: glint [render] SCRIPT [options]
       glint SCRIPT --help         the script's parameters
       glint help COMMAND          a command and its options

commands:
]] .. table.concat(out) .. list_options(~0, options, passes) .. [[

Arguments after -- become the script's `arg`. The command line overrides the script.
Exit: 0 done, 1 a frame failed, 2 usage or script error, 75 disk full (try later), 130 and 143 by signal.
]]
end

-- Returns the command of this name. Fails if there is none.
local function find(name, commands, my)
  local near
  for _, command in ipairs(commands) do
    if command.name == name then return command end
    near = the.nearer(name, near, command.name)
  end
  my.fail(2, name .. ": no such command; "
    .. (near and "did you mean '" .. near .. "'?" or "glint help lists them"))
end

function the.run(my)
  local commands, options, passes = my.tables()
  local bit, is_help = my.command()
  local command
  if is_help and my.arguments[2] then
    my.fail(2, "expected one command, got also '" .. my.arguments[2] .. "'")
  elseif is_help and my.arguments[1] then
    command = find(my.arguments[1], commands, my)
  elseif bit and not is_help then
    for _, one in ipairs(commands) do command = one.bit == bit and one or command end
  end
  if not command then return my.print(usage(commands, options, passes)) end
  my.print(("usage: glint %s %s\n\n%s\n"):format(command.name, command.synopsis, command.help)
    .. list_options(command.bit, options, passes) .. "\nSee man glint for the full manual.\n")
end
