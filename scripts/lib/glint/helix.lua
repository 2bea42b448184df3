-- Alpha helices of polyalanine, side by side along z: a molecule of any size for experiments.
--     helix.each(4, 60, function(atom, x, y, z, residue, chain) ... end)     -- 4 * 60 * 5 heavy atoms, angstroms
-- Pauling's helix: 100 degrees and 1.5 angstroms per residue. CB completes the tetrahedron of CA's neighbours.
local glint = require "glint"

local helix = {}

local RISE, TURN = 1.5, 100 -- angstroms and degrees per residue
local SPACING = 9.6 -- angstroms between the axes
-- Distance from the axis, angle in degrees, height: fitted to a peptide's bond lengths and angles.
local BACKBONE = {
  { "N", 1.5707, -27.201, -0.9087 }, { "CA", 2.29, 0, 0 },
  { "C", 1.6770, 27.714, 1.0405 }, { "O", 1.9476, 22.258, 2.2304 },
}
-- CB = CA + A (b x c) + B b + C c with b = CA - N, c = C - CA, for tetrahedral angles and a bond of 1.53 angstroms.
local A, B, C = -0.5827, 0.5680, -0.5407

local function place(atom, residue)
  local angle = math.rad(atom[3] + TURN * residue)
  return { atom[2] * glint.cos(angle), atom[2] * glint.sin(angle), atom[4] + RISE * residue }
end

local function beta_carbon(n, ca, c)
  local bx, by, bz = ca[1] - n[1], ca[2] - n[2], ca[3] - n[3]
  local cx, cy, cz = c[1] - ca[1], c[2] - ca[2], c[3] - ca[3]
  return {
    ca[1] + A * (by * cz - bz * cy) + B * bx + C * cx,
    ca[2] + A * (bz * cx - bx * cz) + B * by + C * cy,
    ca[3] + A * (bx * cy - by * cx) + B * bz + C * cz,
  }
end

--- Calls f(atom, x, y, z, residue, chain) for each heavy atom: N, CA, C, O, CB of each residue, chain by chain.
---@param count integer  number of helices, arranged in a square
---@param residues integer  number of residues in each helix
---@param f function
function helix.each(count, residues, f)
  local columns = math.ceil(math.sqrt(count))
  for chain = 1, count do
    local dx, dy = SPACING * ((chain - 1) % columns), SPACING * ((chain - 1) // columns)
    for residue = 1, residues do
      local at = {}
      for i, atom in ipairs(BACKBONE) do
        at[i] = place(atom, residue)
        f(atom[1], at[i][1] + dx, at[i][2] + dy, at[i][3], residue, chain)
      end
      local beta = beta_carbon(at[1], at[2], at[3])
      f("CB", beta[1] + dx, beta[2] + dy, beta[3], residue, chain)
    end
  end
end

--- Writes the same atoms as a PDB file. Raises when that fails.
---@param path string
---@param count integer  1 .. 26, because each chain is named by a letter
---@param residues integer  1 .. 9999
function helix.write_pdb(path, count, residues)
  local file = assert(io.open(path, "w"))
  local serial = 0
  helix.each(count, residues, function(atom, x, y, z, residue, chain)
    serial = serial + 1
    file:write(("ATOM  %5d  %-3s ALA %s%4d    %8.3f%8.3f%8.3f  1.00  0.00          %2s\n"):format(
      serial % 100000, atom, string.char(64 + chain), residue, x, y, z, atom:sub(1, 1)))
  end)
  file:write "END\n"
  assert(file:close())
end

return helix
