-- A protein-sized molecule made up on the spot: four alpha helices of polyalanine side by side.
--
-- A helix turns by 100 degrees and climbs 1.5 angstroms a residue; its atoms are placed to have the bond lengths and
-- angles of a peptide (N-CA 1.458, CA-C 1.525, C-N 1.329, C=O 1.231 angstroms).
--     glint scripts/protein.lua                                    1200 atoms: protein.png
--     glint scripts/protein.lua --set residues=200 --set pdb=chain.pdb      and writes what it shows as a PDB file
local glint = require "glint"
local particles, helix = require "glint.particles", require "glint.helix"

local P = glint.params {
  residues = { 60, min = 1, max = 2000, doc = "residues a helix" },
  pdb = { "", doc = "a PDB file to write as well" },
}
local set = particles.new { material = { specular = 0.2, shininess = 40 } }
helix.each(4, P.residues, function(atom, x, y, z) set:add(atom:sub(1, 1), x, y, z) end)
if P.pdb ~= "" then helix.write_pdb(P.pdb, 4, P.residues) end
local scene = glint.scene { ambient = 0.2, background = "#f4f1ea",
  camera = set:camera { from = { 1, -3, 0.8 }, up = { 1, 0, 0.25 }, margin = 0.6 } }
scene:add(glint.directional_light { direction = { -2, 2, -1.5 }, intensity = 0.8 })
scene:add(set:spheres())
scene:render { width = 960, height = 540, samples = 9, output = "protein.png" }
