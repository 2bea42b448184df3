-- Five kinds of light over the same balls. Watch the edge of the shadows, and how the floor darkens away from the lamp.
local glint = require "glint"

local P = glint.params {
  kind = { "point", choices = { "point", "directional", "spot", "disk", "sphere" }, doc = "kind of light" },
  height = { 6, min = 3, max = 15, doc = "height of the lamp" },
  radius = { 1.2, min = 0, max = 3, doc = "radius of a disk or sphere light" },
  cone = { 22, min = 5, max = 45, unit = "°", doc = "half angle of the spot light's cone" },
  falloff = { false, doc = "attenuate with the square of the distance" },
}

local position, down = { 2.2, P.height, 2 }, { -2.2, -P.height, -2 }
local attenuation = P.falloff and { 0, 0, 1 / 45 } or { 1, 0, 0 }
local makers = {
  point = function() return glint.point_light { position = position, attenuation = attenuation } end,
  directional = function() return glint.directional_light { direction = down } end,
  spot = function()
    return glint.spot_light { position = position, direction = down, inner = 0.7 * P.cone, outer = P.cone,
      attenuation = attenuation }
  end,
  disk = function()
    return glint.disk_light { position = position, normal = down, radius = P.radius, attenuation = attenuation }
  end,
  sphere = function()
    return glint.sphere_light { position = position, radius = P.radius, attenuation = attenuation }
  end,
}

local function ball(x, z, radius, color)
  local paint = glint.material { diffuse = color, specular = 0.3, shininess = 60 }
  return glint.sphere { center = { x, radius, z }, radius = radius, material = paint }
end

return glint.animation {
  orbit = true,
  scene = glint.scene {
    camera = glint.camera { eye = { 0, 5, 10.5 }, at = { -0.3, 0.4, 0 }, fov = 27 },
    ambient = 0.08, background = "#10141c",
    makers[P.kind](),
    glint.plane { point = { 0, 0, 0 }, normal = { 0, 1, 0 }, material = glint.material { diffuse = 0.6 } },
    ball(-1.9, -0.4, 1.2, { 0.8, 0.2, 0.15 }), ball(1.1, -1.2, 0.9, { 0.15, 0.4, 0.75 }),
    ball(0.2, 1.5, 0.6, { 0.85, 0.6, 0.15 }),
  },
  frames = 1, width = 640, height = 360, samples = 4,
}
