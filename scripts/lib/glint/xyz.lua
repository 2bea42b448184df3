-- XYZ: a number of atoms, a line of comment, then a line an atom: element (or its number), x, y, z. One frame or more.
--     for frame in xyz.frames "water.xyz" do
--       print(frame.comment, frame.count)
--       for label, x, y, z in frame:atoms() do ... end
--     end
-- Columns after the fourth (charges, velocities, the properties of extended XYZ) are not looked at.
local frames = require "glint.frames"

local xyz = {}

local function read_atom(source, line, index, count)
  if not line then source:fail(("atom %d of %d"):format(index, count), nil) end
  local label, x, y, z = line:match "^%s*(%S+)%s+(%S+)%s+(%S+)%s+(%S+)"
  if not label then source:fail(("atom %d of %d (element x y z)"):format(index, count), line) end
  return label, source:number_of(x, "x"), source:number_of(y, "y"), source:number_of(z, "z")
end

-- Blank lines may stand before a count, and nowhere else.
local function start(source, number)
  local line = source:next()
  while line and not line:find "%S" do line = source:next() end
  if not line and number > 1 then return nil end
  local before = number > 1 and (" of frame %d (the frame before it is complete)"):format(number) or ""
  if not line or not line:find "^%s*%d+%s*$" then source:fail("the number of atoms" .. before, line) end
  local count, index = source:whole(line, "the number of atoms", 1), 0
  local comment = source:next()
  if not comment then source:fail("a line of comment", nil) end
  return { count = count, comment = comment }, function()
    index = index + 1
    if index <= count then return read_atom(source, source:next(), index, count) end
  end
end

--- Iterates over the frames of a file: number, count, comment, and frame:atoms() -> label, x, y, z (angstroms).
---@param path string
function xyz.frames(path)
  return frames.each(path, start)
end

--- One frame, from 1. Default 1.
---@param path string
---@param number? integer
function xyz.frame(path, number)
  return frames.pick(path, xyz.frames(path), number)
end

return xyz
