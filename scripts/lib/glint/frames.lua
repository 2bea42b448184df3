-- What the readers of atoms and points have in common: files of one or several frames, read one atom at a time.
--     for frame in xyz.frames(path) do for label, x, y, z, radius in frame:atoms() do ... end end
-- A frame has number (from 1), count (nil where the format does not say it ahead), and what its format tells. Atoms
-- that a script does not look at are read over, and checked all the same. Nothing is kept: a file of any size takes
-- the memory of a line.
local lines = require "glint.lines"

local frames = {}

local frame = {}
frame.__index = frame

--- Iterates over the atoms: label, x, y, z and, where the file has it, radius. Once a frame.
function frame:atoms()
  if self.is_taken then error(("%s: the atoms of frame %d have been read"):format(self.source.path, self.number), 0) end
  self.is_taken = true
  return function()
    if not self.is_done then return self:take(self.next_atom()) end
  end
end

-- Passes an atom on, and remembers when there was none.
function frame:take(label, ...)
  if label == nil then self.is_done = true end
  return label, ...
end

--- Raises an error at the file and line that the last atom came from.
function frame:fail(expected, got)
  self.source:fail(expected, got)
end

--- Iterates over the frames of a file.
---@param path string
---@param start function  (source, number) -> nil, or the next frame's fields and a function that gives an atom or nil
function frames.each(path, start)
  local source, last, number = lines.open(path), nil, 0
  return function()
    if last and not last.is_done then
      repeat until last.next_atom() == nil
      last.is_done = true
    end
    local fields, next_atom = start(source, number + 1)
    if not fields then
      source:close()
      return nil
    end
    number = number + 1
    fields.source, fields.number, fields.next_atom = source, number, next_atom
    last = setmetatable(fields, frame)
    return last
  end
end

--- One frame of what a reader's frames() iterates over. Raises when there are fewer.
---@param path string
---@param each function
---@param number integer  from 1. Default 1
function frames.pick(path, each, number)
  number = number or 1
  local last = 0
  for found in each do
    last = found.number
    if last == number then return found end
  end
  error(("%s: frame %d expected, got a file of %d"):format(path, number, last), 0)
end

return frames
