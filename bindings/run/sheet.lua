-- Contact sheets of finished files: finds the axes that distinguish the files, and chooses labels, columns and heads.
-- C reads the files and draws.
--
-- A sheet has `path` and the list `files`, its cells row by row, and any of: `positions` ("name=value" lines of each
-- cell, otherwise read from the file), `labels`, `names` ("axis=text", "value=text" and "axis:value=text" lines; the
-- file's come after them), `formats` ("axis=format" lines; an empty
-- axis stands for all others), `label` (with {name} for a value, or "none"), `title`, `columns`, `difference`, `gain`,
-- `size`, `dpi`, `transparent`, `colorbar`, `mixes` (files may come from different scripts or settings), `live`.
local the = ...
local M, finder = {}, the.sheet_axes
local format, find, match, gsub, sub, lower = string.format, string.find, string.match, string.gsub, string.sub,
  string.lower
local concat, ipairs, tonumber = table.concat, ipairs, tonumber

local FAILED <const>, USAGE <const> = 1, 2 -- exit codes
local NAME_MAX <const>, FORMAT_MAX <const> = 100, 80 -- bytes
local LABEL_MAX <const> = 511 -- bytes
local ROW_MAX <const> = 6 -- cells of a single axis in one row, unless columns are given
M.GAIN = 8 -- of differences, unless the sheet has one
M.MAX = 100000 -- cells

function M.ends_in(path, ending) return find(lower(path), "[^/]%." .. ending .. "$") ~= nil end

-- ---- Checks that do not need the files ----

-- Returns whether a text has one conversion of a number, and no other conversion.
local function is_format(text)
  local plain = gsub(text, "%%%%", "\n")
  local rest, short = gsub(plain, "%%[-+# 0]*%d?%d?[eEfgG]", "")
  local last, long = gsub(rest, "%%[-+# 0]*%d?%d?%.%d?%d?[eEfgG]", "")
  return short + long == 1 and not find(last, "%", 1, true)
end

local function check_format(text)
  if #text > FORMAT_MAX or not is_format(text) then
    return format("format: at most %d bytes with one number such as %%.2f, %%g or %%e expected, got '%s'", FORMAT_MAX,
      sub(text, 1, 100))
  end
end

local function check_name(text)
  if text == "" or #text > NAME_MAX then
    return format("names: a name of 1 .. %d bytes expected, got %d bytes", NAME_MAX, #text)
  end
end

local function check_lines(field, lines, check)
  for _, line in ipairs(finder.split_lines(lines)) do
    local text = match(line, "=(.*)")
    local wrong = text and check(text)
    if not text then wrong = format("%s: AXIS=TEXT expected, got '%s'", field, sub(line, 1, 100)) end
    if wrong then return wrong end
  end
end

-- Returns what is wrong with a sheet of `count` pictures, before its files are read; nil: nothing.
function M.check(sheet, count)
  local path = sheet.path
  local is_page = M.ends_in(path, "html")
  if not is_page and not M.ends_in(path, "png") and not M.ends_in(path, "svg") and not M.ends_in(path, "pdf") then
    return format("a file name ending in .png, .svg, .pdf or .html expected, got '%s'", sub(path, 1, 200))
  elseif count < 1 or count > M.MAX then
    return format("pictures: 1 .. %d expected, got %d", M.MAX, count)
  end
  local wrong = check_lines("names", sheet.names, check_name) or check_lines("format", sheet.formats, check_format)
  if wrong then
    return wrong
  elseif sheet.difference and sheet.difference > count then
    return format("difference: a picture 1 .. %d expected, got %d", count, sheet.difference)
  elseif sheet.gain and not sheet.difference then
    return "gain: expected together with difference"
  elseif is_page and sheet.columns then
    return "columns: not for pages; a page has one column for each value of its first axis"
  elseif is_page and (sheet.size or sheet.transparent or sheet.colorbar) then
    return format("%s: has no effect on a page", sheet.colorbar and "colorbar" or sheet.transparent and "transparent"
      or "size")
  end
end

local function check_known(field, lines, axes, has_default)
  for _, line in ipairs(finder.split_lines(lines)) do
    local name, near = match(line, "^[^=]*"), nil
    if not finder.find_line(axes, name) and not (has_default and name == "") then
      for _, axis in ipairs(finder.split_lines(axes)) do near = the.nearer(name, near, match(axis, "^[^=]*")) end
      return format("%s: the sheet has no axis%s '%s'%s", field, has_default and "" or " or value",
        sub(name, 1, NAME_MAX), near and format("; did you mean '%s'?", near) or "")
    end
  end
end

-- Checks that `formats` are of axes in `axes`, which has "axis=..." lines, and that `names` are of axes and values in
-- `values`, which has "axis=..." and "value=..." lines. Returns what is wrong, or nil.
function M.check_axes(sheet, axes, values)
  return check_known("names", sheet.names, values, false) or check_known("format", sheet.formats, axes, true)
end

-- ---- Names, values and labels ----

function M.axis_title(sheet, axis) return finder.find_line(sheet.names, axis.name) or axis.name end

-- Returns value `i` of an axis as the sheet shows it.
function M.spell_value(sheet, axis, i)
  local value = axis.values[i]
  local name = finder.find_line(sheet.names, axis.name .. ":" .. value) or finder.find_line(sheet.names, value)
  if name then return name end
  local number = tonumber(value)
  if not number then return sub(value, 1, 60) end
  local given = finder.find_line(sheet.formats, axis.name) or finder.find_line(sheet.formats, "")
  return sub(format(given or (number < 1e4 and number > -1e4 and "%.4g" or "%.6g"), number), 1, LABEL_MAX)
end

-- Returns a cell's values of the axes from `first` to `last`, with the names or without.
local function spell_cell(sheet, axes, first, last, cell, named, separator)
  local out = {}
  for a = first, last do
    local value = M.spell_value(sheet, axes[a], axes[a].index[cell])
    out[#out + 1] = named and M.axis_title(sheet, axes[a]) .. " = " .. value or value
  end
  return sub(concat(out, separator), 1, LABEL_MAX)
end

local function base_name(path) return match(path, "[^/]*$") end

local function frame_of(pictures, cell) return pictures[cell].frame or "?" end

local function frames_differ(pictures)
  for cell = 2, #pictures do
    if frame_of(pictures, cell) == frame_of(pictures, cell - 1) then return false end
  end
  return #pictures > 1
end

-- Returns the name of a cell's file, with its folders if other cells have files of that name.
local function file_name(sheet, cell)
  local name = base_name(sheet.files[cell])
  for i, path in ipairs(sheet.files) do
    if i ~= cell and base_name(path) == name then return sheet.files[cell] end
  end
  return name
end

-- Returns every axis and its value; without axes the frame number, otherwise the file name.
local function default_label(sheet, axes, pictures, cell)
  if #axes > 0 then return spell_cell(sheet, axes, 1, #axes, cell, true, "\n") end
  return axes.frames_differ and "frame " .. frame_of(pictures, cell) or file_name(sheet, cell)
end

local function label_value(sheet, axes, pictures, cell, name)
  for _, axis in ipairs(axes) do
    if axis.name == name then return M.spell_value(sheet, axis, axis.index[cell]) end
  end
  return name == "file" and base_name(sheet.files[cell]) or name == "frame" and frame_of(pictures, cell) or nil
end

-- Fills in the template of a label. Returns nil and a message if it has an unknown name.
local function fill_label(sheet, axes, pictures, cell)
  local unknown
  local label = gsub(sheet.label, "{([^}]*)}", function(name)
    local value = label_value(sheet, axes, pictures, cell, name)
    unknown = unknown or not value and name
    return value
  end)
  if not unknown then return sub(label, 1, LABEL_MAX) end
  local names = {}
  for i, axis in ipairs(axes) do names[i] = " {" .. axis.name .. "}" end
  return nil, format("label: {%s}: an axis of the sheet, {file} or {frame} expected; the axes are%s%s", unknown,
    #axes > 0 and ":" or " none", concat(names))
end

-- Returns the number of columns: the number of values of a grid's first axis; otherwise the sheet is about square.
local function columns_of(sheet, axes)
  if sheet.columns then return math.min(sheet.columns, axes.cells) end
  if axes.is_grid and (#axes > 1 or axes.cells <= ROW_MAX) then return #axes[1].values end
  return math.ceil(math.sqrt(axes.cells))
end

-- Returns the labels of all cells, or nil and a message.
local function make_labels(sheet, axes, pictures)
  local labels = {}
  for cell = 1, axes.cells do
    local label, message
    if sheet.labels then
      label = sub(sheet.labels[cell], 1, LABEL_MAX)
    elseif axes.has_heads then
      label = axes.is_wrapped and spell_cell(sheet, axes, 1, 1, cell) or ""
    elseif not sheet.label then
      label = default_label(sheet, axes, pictures, cell)
    elseif sheet.label == "none" then
      label = ""
    else
      label, message = fill_label(sheet, axes, pictures, cell)
    end
    if not label then return nil, message end
    labels[cell] = label
  end
  return labels
end

-- ---- The grid ----

-- Returns how many axes of a grid go across: those whose combined values make the columns. A single axis may take
-- several rows. nil: no number of axes fits the columns.
local function count_across(axes, columns)
  local product = 1
  if #axes == 1 then return 1 end
  for a, axis in ipairs(axes) do
    product = product * #axis.values
    if product == columns then return a end
  end
end

local function check_columns(sheet, axes)
  if not axes.is_grid or axes.across then return end
  local counts, product = {}, 1
  for i, axis in ipairs(axes) do
    product = product * #axis.values
    counts[i] = format("%d (%s)", #axis.values, axis.name)
  end
  local first = axes[1]
  return format("columns: %d or %d expected, so that each column of the %s pictures has one value of %s, got %d",
    #first.values, product, sub(concat(counts, " x "), 1, 199), first.name, sheet.columns)
end

local function list_names(sheet, axes, first, last)
  local names = {}
  for a = first, last do names[#names + 1] = M.axis_title(sheet, axes[a]) end
  return concat(names, ", ")
end

-- Returns the heads of columns, rows or blocks: the values of the axes from `first` to `last` in every step-th cell.
local function make_heads(sheet, axes, first, last, step, count, named)
  local heads = {}
  for i = 1, count do heads[i] = spell_cell(sheet, axes, first, last, (i - 1) * step + 1, named, ", ") end
  return heads
end

-- Adds the texts around a grid: some axes go across, the next one goes down, and the others make blocks.
local function surround(sheet, axes, drawing)
  local across, columns = axes.across, drawing.columns
  local down = axes.has_heads and math.min(across + 1, #axes) or #axes
  drawing.across = list_names(sheet, axes, 1, across)
  if across < #axes then drawing.down = list_names(sheet, axes, across + 1, down) end
  if not axes.has_heads or axes.is_wrapped then return end
  drawing.column_heads = make_heads(sheet, axes, 1, across, 1, columns)
  if across == #axes then return end
  local rows = axes.cells // columns
  drawing.row_heads = make_heads(sheet, axes, across + 1, down, columns, rows)
  if down < #axes then
    drawing.block_rows = #axes[down].values
    local block = drawing.block_rows * columns
    drawing.block_heads = make_heads(sheet, axes, down + 1, #axes, block, axes.cells // block, true)
  end
end

local function draw(sheet, axes, labels)
  local drawing = { path = sheet.path, files = sheet.files, labels = labels, columns = columns_of(sheet, axes),
    title = sheet.title, difference = sheet.difference, gain = sheet.gain or M.GAIN, size = sheet.size,
    dpi = sheet.dpi, transparent = sheet.transparent, colorbar = sheet.colorbar, block_rows = 0 }
  if axes.across then surround(sheet, axes, drawing) end
  return the.draw_sheet(drawing)
end

-- Makes a sheet. Returns the exit code and a message; with the code 0, the message is a warning or nil.
function M.make(sheet)
  local wrong = M.check(sheet, #sheet.files)
  if wrong then return USAGE, wrong end
  local pictures, difference, message = finder.read_files(sheet)
  if not pictures then return difference or FAILED, message end
  local is_page = M.ends_in(sheet.path, "html")
  local axes, lines = difference and { cells = #pictures } or finder.find(sheet, pictures, is_page), {}
  for i, axis in ipairs(axes) do lines[i] = axis.name .. "=\n" end
  local known = concat(lines)
  for _, axis in ipairs(axes) do known = known .. concat(axis.values, "=\n") .. "=\n" end
  local columns = columns_of(sheet, axes)
  axes.across = axes.is_grid and count_across(axes, columns)
  axes.frames_differ = not difference and frames_differ(pictures)
  axes.has_heads = axes.is_grid and not sheet.labels and not sheet.label -- heads name the values of the axes
  axes.is_wrapped = #axes == 1 and not is_page and columns < #axes[1].values -- a value below each picture instead
  wrong = M.check_axes(sheet, concat(lines), known) or check_columns(sheet, axes)
  if wrong then return USAGE, wrong end
  sheet.names = (sheet.names or "") .. "\n" .. (pictures[1].names or "")
  local labels, unknown = make_labels(sheet, axes, pictures)
  if not labels then return USAGE, unknown end
  local code
  if is_page then
    code, message = the.sheet_page.make(sheet, axes, pictures, labels)
  else
    code, message = draw(sheet, axes, labels)
  end
  return code, message or difference and difference .. "; the sheet has file names as labels"
end

return M
