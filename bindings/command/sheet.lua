-- Makes a contact sheet of finished frames (glint sheet).
local the = ...

-- Returns the number of the colour map with this name.
local function find_map(my, name, maps)
  local near
  for i, known in ipairs(maps) do
    if known == name then return i end
    near = the.nearer(name, near, known)
  end
  my.fail(2, "--colorbar: viridis, magma, cividis, turbo or coolwarm expected, got '" .. name .. "'"
    .. (near and "; did you mean '" .. near .. "'?" or ""))
end

-- Reads MAP,LOW,HIGH or MAP,LOW,HIGH,TITLE.
local function read_colorbar(my, text)
  local map, low, high, title = text:match "^([^,]*),([^,]*),([^,]*)(.*)$"
  low, high = my.number(low), my.number(high)
  if not (low and high) then
    my.fail(2, "--colorbar: MAP,LOW,HIGH or MAP,LOW,HIGH,TITLE expected, got '" .. text .. "'")
  end
  local maps, size = my.colormaps()
  map = find_map(my, map, maps)
  if #title > size then my.fail(2, ("--colorbar: expected a title of at most %d bytes"):format(size - 1)) end
  return { map = map, low = low, high = high, title = title:sub(2) }
end

-- Turns "AXIS=TEXT,..." into lines. A text without an axis is for all axes.
local function lines_of(text, has_axis)
  if not text then return nil end
  return has_axis and text:gsub(",", "\n") or "=" .. text
end

function the.run(my)
  local given = my.options
  if not given.output then my.fail(2, "expected -o NAME.png, .svg, .pdf or .html") end
  if given.live and not given.live_script then
    my.fail(2, "expected --live=SCRIPT with the script of the pictures")
  end
  local colorbar = given.colorbar and read_colorbar(my, given.colorbar)
  my.sheet { path = given.output, files = the.files(my), label = given.label, title = given.title,
    names = lines_of(given.names, true), formats = lines_of(given.format, (given.format or ""):find "^[^=%%]*="),
    columns = given.columns, difference = given.difference, gain = given.gain, size = given["label-size"],
    dpi = my.number(given.dpi) or 0, transparent = given.transparent, mixes = given.force, colorbar = colorbar }
end
