-- A protein-sized molecule that the script generates: four alpha helices of polyalanine side by side.
--
-- A helix turns by 100 degrees and climbs 1.5 angstroms a residue; its atoms are placed to have the bond lengths and
-- angles of a peptide (N-CA 1.458, CA-C 1.525, C-N 1.329, C=O 1.231 angstroms).
-- Distant atoms fade into the background.
--     glint scripts/protein.lua                                    1200 atoms: protein.png
--     glint scripts/protein.lua --set style=sticks                 bonds, and small balls
--     glint scripts/protein.lua --set residues=200 --set pdb=chain.pdb      and writes what it shows as a PDB file
local glint = require "glint"
local particles, helix, bonds = require "glint.particles", require "glint.helix", require "glint.bonds"

local P = glint.params {
  residues = { 60, min = 1, max = 2000, whole = true, doc = "residues per helix" },
  style = { "balls", choices = { "balls", "sticks" }, doc = "balls of full radius, or of a quarter of it with bonds" },
  pdb = { "", doc = "a PDB file to write as well" },
}
local sticks = P.style == "sticks"
local set = particles.new { scale = sticks and 0.25 or 1, material = { specular = 0.2, shininess = 40 } }
helix.each(4, P.residues, function(atom, x, y, z) set:add(atom:sub(1, 1), x, y, z) end)
if P.pdb ~= "" then helix.write_pdb(P.pdb, 4, P.residues) end
local camera = set:camera { from = { 1, -3, 0.8 }, up = { 1, 0, 0.25 }, margin = 0.6 }
local scene = glint.scene { ambient = 0.2, background = "#f4f1ea", camera = camera, depth_cue = set:depth_cue(camera) }
scene:add(glint.directional_light { direction = { -2, 2, -1.5 }, intensity = 0.8 })
if sticks then scene:add((bonds.new(set))) end
scene:add(set:spheres())
scene:render { width = 960, height = 540, samples = 9, output = "protein.png" }
