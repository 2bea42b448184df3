-- Solids made of other solids: a die (a box, rounded by a ball, minus a ball for each pip), a flange with holes, and a
-- lens, which is the intersection of two balls.
local glint = require "glint"
local P = glint.params {
  turn = { 25, doc = "rotation of the die, degrees" },
  pips = { 0.17, min = 0.02, max = 0.3, doc = "radius of a pip, world units; the die is 2 wide" },
}

local ivory = glint.material { diffuse = { 0.85, 0.8, 0.66 }, specular = 0.3, shininess = 90 }
local ink = glint.material { diffuse = { 0.06, 0.05, 0.08 }, specular = 0.2, shininess = 40 }
local steel = glint.material { diffuse = { 0.2, 0.22, 0.25 }, specular = 0.6, shininess = 60, mirror = 0.25 }
local bore = glint.material { diffuse = { 0.5, 0.2, 0.06 }, specular = 0.4, shininess = 40 }
local glass = glint.material { diffuse = 0, specular = 0.4, shininess = 400, transmission = 1, mirror = 1,
  fresnel = true, absorption = { 0.25, 0.06, 0.12 } }

-- Positions of the pips of 1 .. 6 on a face.
local E = 0.5
local FACES = {
  { { 0, 0 } }, { { -E, -E }, { E, E } }, { { -E, -E }, { 0, 0 }, { E, E } },
  { { -E, -E }, { -E, E }, { E, -E }, { E, E } }, { { -E, -E }, { -E, E }, { E, -E }, { E, E }, { 0, 0 } },
  { { -E, -E }, { -E, 0 }, { -E, E }, { E, -E }, { E, 0 }, { E, E } },
}

local function die()
  local rounded = glint.intersection { glint.box { min = { -1, -1, -1 }, max = { 1, 1, 1 } },
    glint.sphere { center = { 0, 0, 0 }, radius = 1.42 } }
  local parts = { rounded, material = ivory, name = "die" }
  for number, places in ipairs(FACES) do -- opposite faces add up to 7
    local axis, side = (number - 1) % 3 + 1, number <= 3 and 1 or -1
    if number > 3 then axis = (6 - number) % 3 + 1 end
    for _, at in ipairs(places) do
      local center = {}
      center[axis], center[axis % 3 + 1], center[(axis + 1) % 3 + 1] = side * 1.04, at[1], at[2]
      parts[#parts + 1] = glint.sphere { center = center, radius = P.pips, material = ink }
    end
  end
  return glint.difference(parts)
end

-- The holes end at the flange's faces: a cutter may be flush with the solid that it cuts.
local function flange()
  local body = glint.union { glint.cylinder { base = { 0, 0, 0 }, top = { 0, 0.4, 0 }, radius = 1.6 },
    glint.cylinder { base = { 0, 0.4, 0 }, top = { 0, 1.5, 0 }, radius = 0.8 },
    glint.cone { base = { 0, 0.4, 0 }, top = { 0, 1.45, 0 }, radius = 1.1 } }
  local parts = { body,
    glint.cylinder { base = { 0, 0, 0 }, top = { 0, 1.5, 0 }, radius = 0.5, material = bore },
    glint.box { min = { 0.3, 0, -0.12 }, max = { 0.66, 1.5, 0.12 }, material = bore },
    material = steel, name = "flange" }
  for i = 0, 5 do
    local x, z = 1.3 * glint.cos(i * math.pi / 3), 1.3 * glint.sin(i * math.pi / 3)
    parts[#parts + 1] = glint.cylinder { base = { x, 0, z }, top = { x, 0.4, z }, radius = 0.16, material = bore }
  end
  return glint.difference(parts)
end

local function lens()
  return glint.intersection { glint.sphere { center = { 0, 0, -1.1 }, radius = 1.5 },
    glint.sphere { center = { 0, 0, 1.1 }, radius = 1.5 }, material = glass, name = "lens" }
end

-- Moves a solid as a whole.
local function at(x, y, z, angle, shape)
  return glint.group { shape, transform = glint.translate(x, y, z) * glint.rotate("y", angle) }
end

local floor = glint.pattern(function(p, s)
  return glint.mix({ 0.62, 0.6, 0.56 }, { 0.32, 0.36, 0.42 }, glint.checker(p, s.footprint))
end)

return glint.scene {
  camera = glint.camera { eye = { 0.3, 4.6, 9.2 }, at = { -0.1, 0.8, 0 }, fov = 33 },
  ambient = 0.22, background = { 0.55, 0.65, 0.75 },
  glint.sphere_light { position = { 5, 9, 6 }, radius = 0.8, samples = 16, intensity = 0.9 },
  glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = floor } },
  at(-2.3, 1, -0.2, P.turn, die()), at(1.9, 0, -1, -35, flange()), at(0.4, 1.02, 2.1, 12, lens()),
}
