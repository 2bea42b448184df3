-- The axes of a sheet: the values that distinguish its cells. Reads the files.
local the = ...
local M = {}
local format, find, match, gmatch, sub = string.format, string.find, string.match, string.gmatch, string.sub
local concat, sort, ipairs, next = table.concat, table.sort, ipairs, next

local USAGE <const> = 2 -- exit code
local AXES_MAX <const> = 16

-- ---- "name=value" lines ----

-- Returns the list of lines.
function M.split_lines(lines)
  local out = {}
  if lines and lines ~= "" then
    for line in gmatch(lines, "([^\n]*)\n?") do out[#out + 1] = line end
  end
  return out
end

-- Returns the value of the line "name=value", or nil.
function M.find_line(lines, name)
  local _, last = find("\n" .. (lines or ""), "\n" .. name .. "=", 1, true)
  return last and match(lines, "[^\n]*", last)
end

-- ---- The files and their axes ----

-- Reads the files. Returns the pictures and, if they come from different scripts, how they differ. Returns nil, the
-- exit code and a message if one is missing or differs in size.
function M.read_files(sheet)
  local pictures, difference = {}, nil
  for i, path in ipairs(sheet.files) do
    local picture, code, message = the.read_picture(path)
    if not picture then return nil, code, message end
    pictures[i] = picture
    local first, first_path = pictures[1], sheet.files[1]
    if picture.width ~= first.width or picture.height ~= first.height then
      return nil, USAGE, format("%s: %dx%d pixels expected, as in %s, got %dx%d", sub(path, 1, 200), first.width,
        first.height, sub(first_path, 1, 200), picture.width, picture.height)
    end
    if not sheet.mixes then difference = difference or the.match_pictures(first, first_path, picture, path) end
  end
  return pictures, difference
end

-- Returns an axis with the values of all cells; value_of(cell) returns one.
local function new_axis(name, count, value_of)
  local axis, known = { name = name, values = {}, index = {} }, {}
  for cell = 1, count do
    local value = value_of(cell)
    if not known[value] then
      axis.values[#axis.values + 1] = value
      known[value] = #axis.values
    end
    axis.index[cell] = known[value]
  end
  return axis
end

-- Adds an axis for every name in the first cell's lines; without `all`, only for names whose values differ.
local function add_axes(axes, lines_of, all)
  for _, line in ipairs(M.split_lines(lines_of(1))) do
    local name = match(line, "^([^=]*)=")
    if name and not axes.known[name] and #axes < AXES_MAX then
      local axis = new_axis(name, axes.cells, function(cell) return M.find_line(lines_of(cell), name) or "-" end)
      if all or #axis.values > 1 then
        axes[#axes + 1], axes.known[name] = axis, true
      end
    end
  end
end

-- Returns whether the cells are all combinations of the values, in order; the first axis changes fastest.
local function is_grid(axes)
  local stride = 1
  for _, axis in ipairs(axes) do
    for cell = 1, axes.cells do
      if axis.index[cell] ~= (cell - 1) // stride % #axis.values + 1 then return false end
    end
    stride = stride * #axis.values
  end
  return #axes > 0 and stride == axes.cells
end

-- Sorts the axes so that the one that changes fastest comes first.
local function sort_axes(axes)
  for rank, axis in ipairs(axes) do
    axis.rank, axis.change = rank, 1
    while axis.index[axis.change] == 1 do axis.change = axis.change + 1 end -- the first cell with another value
  end
  sort(axes, function(a, b)
    if a.change ~= b.change then return a.change < b.change end
    return a.rank < b.rank
  end)
end

-- Returns the axis of the frames of a film at each place of the other axes, or nil if not each place has as many. Its
-- values are numbered from 1.
local function new_frame_axis(axes)
  local counts, nth, most = {}, {}, 0
  for cell = 1, axes.cells do
    local place = {}
    for a, axis in ipairs(axes) do place[a] = axis.index[cell] end
    place = concat(place, " ")
    counts[place] = (counts[place] or 0) + 1
    nth[cell] = counts[place]
    if nth[cell] > most then most = nth[cell] end
  end
  for _, count in next, counts do
    if count ~= most then return nil end
  end
  return most > 1 and new_axis("frame", axes.cells, function(cell) return format("%d", nth[cell]) end) or nil
end

-- Finds the axes: first the axes of sweeps, then the parameters, options and passes that differ. The pages of sweeps
-- over films also have an axis of frames.
function M.find(sheet, pictures, is_page)
  local axes = { cells = #pictures, known = {} }
  local function texts(keyword) return function(cell) return pictures[cell][keyword] end end
  local positions = sheet.positions
  add_axes(axes, positions and function(cell) return positions[cell] end or texts("sweep"), true)
  add_axes(axes, texts("params"), false)
  add_axes(axes, texts("options"), false)
  local pass = new_axis("pass", #pictures, function(cell) return pictures[cell].pass or "beauty" end)
  if #pass.values > 1 and #axes < AXES_MAX then axes[#axes + 1] = pass end
  axes.is_grid = is_grid(axes)
  if is_page and not axes.is_grid and #axes > 0 and #axes < AXES_MAX then axes[#axes + 1] = new_frame_axis(axes) end
  if not axes.is_grid then -- passes, and the last name in files of nested loops, change fastest
    sort_axes(axes)
    axes.is_grid = is_grid(axes)
    if not axes.is_grid then sort(axes, function(a, b) return a.rank < b.rank end) end
  end
  return axes
end

return M
