-- A box of 100,000 particles that the script generates: a crystal of two kinds that melts towards one side.
--     glint scripts/particle_box.lua                             particle_box.png
--     glint scripts/particle_box.lua --set count=1000000 --set format=f32
--     glint scripts/particle_box.lua --set file=melt.dump --set frame=3     a frame of a LAMMPS dump instead
--     glint scripts/particle_box.lua --set count=1000 --set longest=1.1     bonds; in a dump also across its faces
local glint = require "glint"
local particles, lammps, bonds = require "glint.particles", require "glint.lammps", require "glint.bonds"

local P = glint.params {
  count = { 100000, min = 1, max = 1e8, whole = true, doc = "number of particles" },
  format = { "f64", choices = { "f64", "f32" }, doc = "number format of the spheres; f32 takes half the memory" },
  file = { "", doc = "a LAMMPS dump file" },
  frame = { 1, min = 1, max = 1e9, whole = true, doc = "number of the frame in the file" },
  longest = { 0, min = 0, max = 1000, doc = "longest bond to draw, with radii halved; 0: no bonds" },
}
local joins = P.longest > 0
local set = particles.new { format = P.format, scale = joins and 0.5 or 1,
  material = { specular = 0.15, shininess = 30 } }
if P.file ~= "" then
  set:add_frame(lammps.frame(P.file, P.frame, { wrap = true }))
else
  local side, state = math.ceil(P.count ^ (1 / 3)), 1
  local function noise(size) -- the same numbers on every machine
    state = state * 48271 % 0x7fffffff
    return (state / 0x7fffffff - 0.5) * size
  end
  for i = 0, P.count - 1 do
    local x, y, z = i // (side * side), i // side % side, i % side
    local melt = 1.6 * math.max(0, x / side - 0.4)
    set:add("type" .. (x + y + z) % 2 + 1, x + noise(melt), y + noise(melt), z + noise(melt))
  end
end
local scene = glint.scene { ambient = 0.25, background = "#10131a", camera = set:camera { from = { -0.8, 1.1, 1.5 } } }
scene:add(glint.directional_light { direction = { 1, -2, -1.4 }, intensity = 0.75 })
local joined = joins and bonds.new(set, { distance = P.longest, radius = P.longest / 8 })
if joined then scene:add(joined) end
scene:add(set:spheres())
scene:render { width = 800, height = 600, samples = 4, output = "particle_box.png" }
