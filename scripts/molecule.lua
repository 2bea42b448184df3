-- A molecule from a file, .xyz or .pdb, as balls of the elements' van der Waals radii, or as balls and sticks.
--     glint scripts/molecule.lua                                   caffeine: molecule.png
--     glint scripts/molecule.lua --set style=sticks                small balls, joined by bonds
--     glint scripts/molecule.lua --set file=1abc.pdb --set scale=0.5 --outline black
-- Scripts in scripts/ find the module in scripts/lib; after `make install` every script does; otherwise set
-- LUA_PATH='.../scripts/lib/?.lua;;'.
local glint = require "glint"
local particles, bonds = require "glint.particles", require "glint.bonds"

local P = glint.params {
  file = { (arg[0]:match "^.*/" or "") .. "data/caffeine.xyz", doc = "a file .xyz or .pdb" },
  frame = { 1, min = 1, max = 1e9, whole = true, doc = "number of the frame or model in the file" },
  style = { "balls", choices = { "balls", "sticks" }, doc = "balls of full radius, or of a quarter of it with bonds" },
  scale = { 1, min = 0.01, max = 10, doc = "factor of the radii" },
}
local reader = require(P.file:lower():find "%.pdb$" and "glint.pdb" or "glint.xyz")
local sticks = P.style == "sticks"
local set = particles.new { scale = sticks and P.scale / 4 or P.scale, material = { specular = 0.25, shininess = 60 } }
set:add_frame(reader.frame(P.file, P.frame))
local scene = glint.scene { ambient = 0.25, background = "white",
  camera = set:camera { from = { 0.5, -0.6, 2 }, margin = 0.75 } }
scene:add(glint.directional_light { direction = { -1, -1.5, -2 }, intensity = 0.75, shadows = true })
local joined = sticks and bonds.new(set)
if joined then scene:add(joined) end
scene:add(set:spheres())
scene:render { width = 800, height = 600, samples = 16, output = "molecule.png" }
