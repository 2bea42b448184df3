-- sweep.sheet: the contact sheet of a sweep.
--
--     sheet = { label = true, names = { shininess = "n" }, format = "%.0f", passes = true, columns = 4, difference = 1,
--               gain = 8, title = "...", colorbar = bar, output = "sheet.png" }
local the = ...
local M, sheets, sweep = {}, the.sheet, the.sweep
local format, find, match, gmatch = string.format, string.find, string.match, string.gmatch
local concat, sort, ipairs, next, tostring, type = table.concat, table.sort, ipairs, next, tostring, type
local floor, tointeger = math.floor, math.tointeger

-- ---- Checking ----

local function text(expected)
  return function(value, path)
    if type(value) ~= "string" or value == "" or find(value, "\0", 1, true) then the.refuse(value, path, expected) end
  end
end

local function number(min, max, expected, is_whole)
  return function(value, path)
    local x = the.read_number(path, value)
    if not (x >= min and x <= max) or (is_whole and x ~= floor(x)) then the.refuse(value, path, expected) end
  end
end

local function flag(value, path)
  if type(value) ~= "boolean" then the.refuse(value, path, "boolean") end
end

local axis_text = text("table { axis = text }")

local function texts(value, path)
  if type(value) ~= "table" then the.refuse(value, path, "table { axis = text }") end
  for axis, name in next, value do
    if type(axis) ~= "string" then the.bad_key(axis, path) end
    axis_text(name, path)
  end
end

local function label(value, path)
  if type(value) ~= "boolean" and type(value) ~= "function" and type(value) ~= "string" then
    the.refuse(value, path, "boolean, string or function")
  end
end

local function output(value, path)
  text("file name")(value, path)
  local wrong = sheets.check({ path = value }, 1)
  if wrong then the.raise(path .. ": " .. wrong) end
end

local CHECKS <const> = { label = label, columns = number(1, 65535, "whole number 1 .. 65535", true),
  difference = number(1, sheets.MAX, "number of a frame, from 1,", true),
  gain = number(1e-3, 1e6, "number 0.001 .. 1000000"), size = number(1, 10000, "points 1 .. 10000"),
  dpi = number(0, 1e6, "number 0 .. 1000000"), names = texts, transparent = flag, passes = flag,
  title = text("text"), output = output,
  format = function(value, path)
    local is_text = type(value) == "string" or type(value) == "number"
    return (is_text and text("text") or texts)(value, path)
  end,
  colorbar = function(value, path)
    if not the.is_colorbar(value) then the.refuse(value, path, "glint.colorbar") end
  end }

-- Checks the fields of sweep.sheet.
function M.check_fields(sheet)
  if type(sheet) ~= "table" then the.refuse(sheet, "sweep.sheet", "table") end
  for name, value in next, sheet do
    if type(name) ~= "string" then the.bad_key(name, "sweep.sheet") end
    if not CHECKS[name] then the.no_sheet_field(name) end
    CHECKS[name](value, "sweep.sheet." .. name)
  end
end

-- Returns a field as "axis=text" lines. The field is a table { axis = text }, or one text for all axes, whose line has
-- an empty name.
local function lines_of(field)
  if type(field) == "string" then return "=" .. field end
  local lines = {}
  for axis, name in next, field or {} do lines[#lines + 1] = axis .. "=" .. name .. "\n" end
  sort(lines) -- they are stored in files
  return concat(lines)
end

-- Returns the names that the sheet of a sweep gives to axes and values, as lines. sheet: nil if there is none.
function M.list_names(sheet) return lines_of(sheet and sheet.names) end

local function describe(sheet, path)
  local template = sheet.label
  return { path = path, names = lines_of(sheet.names), formats = lines_of(sheet.format), title = sheet.title,
    label = template == false and "none" or type(template) == "string" and template or nil,
    columns = tointeger(sheet.columns), difference = tointeger(sheet.difference), gain = sheet.gain, size = sheet.size,
    dpi = sheet.dpi, transparent = sheet.transparent, colorbar = sheet.colorbar }
end

-- Checks a sheet against the axes of its sweep.
function M.check(sheet, axes, frames)
  local lines = sweep.place_of_frame(axes, 1) .. (sheet.passes and "\npass=" or "")
  local names = sweep.list_values(axes) .. (sheet.passes and "\npass=" or "")
  local described = describe(sheet, sheet.output or "sheet.png")
  local wrong = sheets.check(described, frames) or sheets.check_axes(described, lines, names)
  if wrong then the.raise("sweep.sheet." .. wrong) end
  for name in gmatch(type(sheet.label) == "string" and sheet.label or "", "{([^}]*)}") do
    if not the.sheet_axes.find_line(lines, name) and name ~= "file" and name ~= "frame" then
      the.raise(format("sweep.sheet.label: {%s}: the name of an axis, {file} or {frame} expected", name))
    end
  end
end

-- ---- Drawing ----

-- Returns the default name: "out/%04d.png" -> "out/sheet.png"; "x_%04d.png", "x.png" and "x.mp4" -> "x_sheet.png".
local function default_output(pattern, is_verbatim)
  local folder, name = match(pattern, "^(.*/)([^/]*)$")
  name = name or pattern
  local stem = is_verbatim and name or match(name, "^[^%%#]*")
  if stem == name then stem = match(name, "^(.*)%.") or name end
  stem = match(stem, "^(.-)[_%-%. ]*$")
  return (folder or "") .. stem .. (stem == "" and "sheet.png" or "_sheet.png")
end

-- Returns the passes on the sheet: the picture, and with `passes` in the sheet those that are rendered.
local function list_passes(sheet, rendered)
  local passes = { "beauty" }
  for _, pass in ipairs(sheet.passes and rendered or {}) do
    if pass == "light:*" then
      the.raise("sweep.sheet.passes: expected the names of lights in the passes light:NAME, got 'light:*'")
    end
    passes[#passes + 1] = pass
  end
  return passes
end

-- Returns a label from the script's function(values, n, pass), with values[name] = value for each axis.
local function call_label(of, axes, n, pass)
  local result = of(sweep.values_of_frame(axes, n), n, pass)
  if type(result) ~= "string" and type(result) ~= "number" then
    the.refuse(result, "sweep.sheet.label: the function's result", "string")
  end
  return tostring(result)
end

-- Adds the cells to a described sheet. The passes change fastest.
local function add_cells(described, axes, frames, what, passes, of)
  if frames > sheets.MAX // #passes then
    the.raise(format("sweep.sheet: at most %d pictures expected", sheets.MAX))
  end
  local files, positions, labels = {}, {}, of and {}
  for n = 1, frames do
    local position = sweep.place_of_frame(axes, n)
    for _, pass in ipairs(passes) do
      local cell = #files + 1
      files[cell], positions[cell] = the.name_file(what.naming, what.first + n - 1, pass), position
      if of then labels[cell] = call_label(of, axes, n, pass) end
    end
  end
  described.files, described.positions, described.labels = files, positions, labels
end

-- Returns a note if files are missing, with the frames between which they are.
local function note_missing(files, first, passes)
  local from, to
  for cell, path in ipairs(files) do
    if not the.is_readable(path) then
      to = first + (cell - 1) // passes
      from = from or to
    end
  end
  if not from then return nil end
  return from == to and format("not drawn: frame %d is not rendered yet", from)
    or format("not drawn: frames between %d and %d are not rendered yet", from, to)
end

-- Draws the sheet of a sweep. `what` has the number of the `first` frame, the `naming` of files with its `pattern`, the
-- passes that are `rendered`, the pictures' `dpi`, the `live` HTML, and the flags `is_verbatim` (the pattern has no
-- place for a number), `is_swept` (by --sweep) and `is_partial` (some frames were not selected, so that missing files
-- only give a note).
function M.make(sheet, axes, frames, what)
  local path, passes = sheet.output or default_output(what.pattern, what.is_verbatim), list_passes(sheet, what.rendered)
  if what.first > 1 and (not sheet.output or what.is_swept) then -- a later sweep of the same run
    local stem, ending = match(path, "^(.*)(%.[^.]*)$")
    path = format("%s_%04d%s", stem, what.first, ending)
  end
  local described = describe(sheet, path)
  add_cells(described, axes, frames, what, passes, type(sheet.label) == "function" and sheet.label or nil)
  described.live, described.dpi = what.live, sheet.dpi and sheet.dpi > 0 and sheet.dpi or what.dpi
  if not the.note_written("sheet", path, what.first) then return end
  local code, message = 0, what.is_partial and note_missing(described.files, what.first, #passes)
  if not message then
    code, message = sheets.make(described)
    if code == 0 then return the.report_figure("sheet", path, #described.files) end
    message = what.is_partial and "not drawn: " .. message or message
  end
  if what.is_partial then the.note(path .. ": " .. message) else the.fail_run(code, path .. ": " .. message) end
end

return M
