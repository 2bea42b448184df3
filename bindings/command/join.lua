-- Joins the parts that --region has rendered into one picture, byte for byte the whole frame (glint join).
local the = ...

-- The text entries of the whole frame's file, in the order of the file.
local KEYWORDS <const> = { "Software", "glint:key", "glint:script", "glint:source", "glint:params", "glint:frame",
  "glint:pass", "glint:options", "glint:sweep", "glint:encoder" }
-- Passes that are not colours.
local LINEAR <const> = { depth = true, normal = true, object_id = true, alpha = true, outline = true, refined = true }

-- Reads a part, its position and its texts.
local function read_part(my, path, first)
  local part = { path = path }
  part.picture, part.width, part.height = my.read(path)
  part.whole, part.options = my.text(part.picture, "glint:whole"), my.text(part.picture, "glint:options")
  local region = part.whole and part.options and ("\n" .. part.options):match "\nregion=([^\n]*)"
  local width, height
  if region then part.x, part.y, width, height = my.region(region) end
  if not part.x then my.fail(2, path .. ": expected a .png rendered with --region") end
  if first and part.whole ~= first.whole then
    my.fail(2, ("%s and %s are parts of different frames: scene, frame, options, version or encoder differ")
      :format(path, first.path))
  end
  if part.width ~= width or part.height ~= height then
    my.fail(2, path .. ": its size differs from the region that is recorded in it")
  end
  return part
end

-- Sets the options of the whole frame: the options of a part without its region. Returns them as the file stores them.
local function set_options(my, options)
  local out = {}
  for line in options:gmatch "[^\n]+" do
    local name, value = line:match "^([^=]*)=?(.*)$"
    if name ~= "region" then
      out[#out + 1] = line
      my.set_option(name, value)
    end
  end
  return table.concat(out, "\n")
end

local function texts_of(my, part, options)
  local out = {}
  for _, keyword in ipairs(KEYWORDS) do
    local value = my.text(part.picture, keyword)
    if keyword == "glint:key" then value = part.whole end
    if keyword == "glint:options" then value = options end
    if value then out[#out + 1] = { keyword, value } end
  end
  return out
end

function the.run(my)
  if not (my.options.output and my.options.output:lower():find "%.png$") then my.fail(2, "-o NAME.png expected") end
  local parts = {}
  for i, path in ipairs(the.files(my)) do parts[i] = read_part(my, path, parts[1]) end
  local texts = texts_of(my, parts[1], set_options(my, parts[1].options))
  local code, message = my.join(parts, texts, LINEAR[my.text(parts[1].picture, "glint:pass")])
  if code then
    local number, what = message:match "^parts%[(%d+)%][^:]*: (.*)$"
    my.fail(code, number and parts[tonumber(number)].path .. ": " .. what or message)
  end
  if my.options.json then
    my.event(('{"event":"joined","file":%s,"parts":%d}'):format(the.json(my.options.output), #parts))
  else
    my.say(("%s: joined from %d part%s\n"):format(my.options.output, #parts, #parts == 1 and "" or "s"))
  end
end
