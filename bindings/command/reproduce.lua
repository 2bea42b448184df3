-- Renders the frame of a finished file again and compares the two (glint reproduce).
local the = ...

-- Exit codes, in addition to the usual ones.
local SAME_PIXELS <const>, DIFFERENT <const>, UNREADABLE <const> = 3, 4, 5

-- Calls `take` for each line "name=value".
local function each_line(lines, take)
  for name, value in lines:gmatch "([^=\n]*)=([^\n]*)" do take(name, value) end
end

-- Returns the parameters to set. Swept ones come last, in the order of the axes, because files store this.
local function list_sets(params, sweep)
  local sets, swept = {}, 0
  each_line(params, function(name, value) -- line breaks are stored as a backslash and an n
    sets[#sets + 1] = { name = name, text = value:gsub("\\n", "\n") }
  end)
  each_line(sweep, function(name, value)
    for i, set in ipairs(sets) do
      if set.name == name then -- otherwise an axis of the script itself
        table.remove(sets, i)
        sets[#sets + 1], swept = { name = name, text = value }, swept + 1
        break
      end
    end
  end)
  return sets, swept
end

-- Sets the request of the run from the texts of the file.
local function request(my, text)
  if text "glint:key" == "" or text "glint:frame" == "" then
    my.fail(UNREADABLE, my.file .. ": has no key and frame number, so glint cannot render it again")
  end
  my.set_params(list_sets(text "glint:params", text "glint:sweep"))
  each_line(text "glint:options", function(name, value) my.set_option(name, value) end)
  local wrong = my.check(text "glint:frame")
  if wrong then my.fail(UNREADABLE, wrong) end
end

-- The texts whose change explains a difference, and their names in messages.
local NAMED <const> = { { "Software", "engine version" }, { "glint:script", "script" }, { "glint:encoder", "encoder" } }

-- Returns why the files differ, as far as their texts show.
local function reason_of(text, made)
  for _, one in ipairs(NAMED) do
    local had, has = text(one[1]), made(one[1])
    if has and had ~= has then
      return ("another %s: '%s' then, '%s' now"):format(one[2], had == "" and "not noted" or had, has)
    end
  end
  local is_same_source = made "glint:source" == text "glint:source"
  if made "glint:key" == text "glint:key" then
    return is_same_source
      and "the frame has the same key: the file was changed, or compressed on another kind of processor"
      or "another script: its text has changed, but not the parts that this frame depends on"
  end
  return is_same_source and "the script or a file that it reads has changed, and now describes another frame"
    or "another script: its text has changed"
end

-- Returns whether the bytes of two files are equal.
local function is_same(my, path, other_path)
  local file <close>, why = io.open(path, "rb")
  local other <close>, other_why = io.open(other_path, "rb")
  if not (file and other) then my.fail(1, why or other_why) end
  return file:read "a" == other:read "a"
end

-- Returns the verdict as an exit code, the largest difference, and the reason of a difference.
local function compare(my, text, path)
  if is_same(my, my.file, path) then return 0, 0 end
  local error, wrong, made = my.compare(my.file, path)
  if wrong then return DIFFERENT, error, wrong end
  local reason = reason_of(text, function(keyword) return my.text(made, keyword) end)
  return error > 0 and DIFFERENT or SAME_PIXELS, error, reason
end

local function report(my, frame, verdict, error, reason)
  if my.options.json then
    local word = verdict == 0 and "same" or verdict == SAME_PIXELS and "pixels" or "different"
    my.print(('{"event":"reproduce","file":%s,"script":%s,"frame":%s,"result":"%s"'):format(the.json(my.file),
      the.json(my.script), frame, word))
    if verdict ~= 0 then my.print((',"max_error":%s,"reason":%s'):format(the.json(error), the.json(reason))) end
    my.print "}\n"
  elseif verdict == 0 then
    my.print(my.file .. ": the same, byte for byte\n")
  elseif verdict == SAME_PIXELS then
    my.print(my.file .. ": the same pixels, other bytes: " .. reason .. "\n")
  else
    my.print(("%s: different, by at most %.3g of 1: %s\n"):format(my.file, error, reason))
  end
end

function the.run(my)
  local had = my.read(my.file)
  local function text(keyword) return my.text(had, keyword) or "" end
  request(my, text)
  local path = my.render(text "glint:pass", text "glint:frame")
  local verdict, error, reason = compare(my, text, path)
  report(my, text "glint:frame", verdict, error, reason)
  return verdict
end
