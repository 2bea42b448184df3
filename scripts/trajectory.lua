-- A trajectory, frame by frame: particles in their periodic cell, with axes along the cell, coloured by a column.
--     glint scripts/trajectory.lua -o film.mp4                             a wave runs through a crystal
--     glint scripts/trajectory.lua --set file=melt.dump --set column=c_pe --set map=magma --set low=-7 --set high=-5
--     glint scripts/trajectory.lua --set file=run.xyz -f 90                one frame; earlier frames are skipped once
-- `glint.xyz` and `glint.lammps` continue from the previous frame: a film reads the file once.
local glint = require "glint"
local particles, boxes = require "glint.particles", require "glint.box"

local P = glint.params {
  file = { "", doc = "a LAMMPS dump, or extended XYZ (.xyz); none: a crystal that the script writes" },
  column = { "vel_z", doc = "the column whose values are colours" },
  map = { "coolwarm", choices = { "viridis", "magma", "cividis", "turbo", "coolwarm" }, doc = "colour map" },
  low = { -2, doc = "value of the first colour" },
  high = { 2, doc = "value of the last colour" },
}

local FRAMES, SIDE = 48, 12

-- Writes a wave that starts in the middle of a crystal, as extended XYZ.
local function write_wave(path)
  local file <close> = assert(io.open(path, "wb"))
  local middle = (SIDE - 1) / 2
  for n = 0, FRAMES - 1 do
    local rows = {}
    for i = 0, SIDE ^ 3 / 2 - 1 do
      local x, y, z = i % SIDE, i // SIDE % SIDE, i // SIDE ^ 2
      local far = math.sqrt((x - middle) ^ 2 + (y - middle) ^ 2)
      local phase, strong = 2 * math.pi * (n / FRAMES - far / 7), 0.45 * glint.exp(-far / 12)
      rows[#rows + 1] = ("Ar %.4f %.4f %.4f %.4f"):format(x + 0.5, y + 0.5, z + 0.5 + strong * glint.sin(phase),
        2 * math.pi * strong * glint.cos(phase))
    end
    file:write(#rows, ('\nLattice="%d 0 0 0 %d 0 0 0 %d" Properties=species:S:1:pos:R:3:vel_z:R:1\n'):format(SIDE, SIDE,
      SIDE // 2), table.concat(rows, "\n"), "\n")
  end
end

local file, is_own = P.file, P.file == ""
if is_own then
  file = os.tmpname()
  write_wave(file)
end
local reader = require((is_own or file:lower():find "%.xyz$") and "glint.xyz" or "glint.lammps")
local film = reader.film(file)
-- Removes the file at the end. In a browser scripts have no finalizers, and their files vanish with the page.
local _, guard = pcall(setmetatable, {}, { __gc = function() return is_own and os.remove(file) end })

local scene = glint.scene { ambient = 0.3, background = "white",
  glint.directional_light { direction = { 1, 2, -2.4 }, intensity = 0.72 } }
local shown, axes = { guard = guard }, nil

local function show(_, n)
  for i = #shown, 1, -1 do scene:remove(table.remove(shown, i)) end
  local frame = film:frame(n)
  local set = particles.new { radius = is_own and 0.5 or nil, material = { specular = 0.15, shininess = 30 },
    color_by = { column = P.column, map = P.map, low = P.low, high = P.high } }
  set:add_frame(frame)
  shown[1] = set:spheres()
  local cell = frame.box or frame.cell
  if cell then
    shown[2] = boxes.edges(cell)
    axes = axes or scene:add(glint.axes { box = cell, color = "black" })
    axes.box = cell
  end
  for _, shape in ipairs(shown) do scene:add(shape) end
  return set
end

local frames = film:length()
scene.camera = show(0, 1):camera { from = { -0.75, -1.5, 1.05 }, up = { 0, 0, 1 },
  margin = 1.15 } -- fits the first frame; leaves space for the numbers
return glint.animation { scene = scene, frames = frames, cyclic = is_own, fps = 24, width = 800, height = 600,
  samples = 4, frame = show }
