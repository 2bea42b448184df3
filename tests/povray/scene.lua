-- tests/command/povray.sh renders this scene and compares it with POV-Ray's picture of the same numbers.
local glint = require "glint"
local P = glint.params {
  model = { "phong", choices = { "phong", "blinn_phong" } },
  light = { "point", choices = { "point", "directional", "spot", "fade", "area" } },
  surfaces = { "plain", choices = { "plain", "mirror", "glass", "absorbing", "inside", "fresnel", "solids", "open",
     "rings", "combined", "faceted", "smooth", "stretched", "prism", "nested", "checker", "sky", "lens", "translucent" } },
  sky = { "", doc = "the PNG file of the sky" },
  projection = { "perspective", choices = { "perspective", "orthographic" } },
}
local w = dofile "tests/povray/workshop.lua"

local place, color, spot = w.light.position, w.light.color, w.spot
local lights = {
  point = function() return { glint.point_light { position = place, color = color } } end,
  directional = function() return { glint.directional_light { direction = w.light.direction, color = color } } end,
  spot = function()
    return { glint.spot_light { position = place, color = color, direction = spot.direction, inner = spot.inner,
      outer = spot.outer } }
  end,
  fade = function()
    return { glint.point_light { position = place, color = color, attenuation = { 0.5, 0, 0.5 / w.fade ^ 2 } } }
  end,
  area = function()
    local list, side = {}, w.grid.side
    for i = 0, side * side - 1 do
      local x, z = (i % side / (side - 1) - 0.5) * w.grid.width, (i // side / (side - 1) - 0.5) * w.grid.width
      list[i + 1] = glint.point_light { position = { place[1] + x, place[2], place[3] + z }, color = color,
        intensity = 1 / (side * side) }
    end
    return list
  end,
}

local camera = { eye = w.eye, at = w.at, projection = P.projection }
if P.projection == "perspective" then
  camera.fov = w.fov
else
  camera.height = w.height
end
if P.surfaces == "lens" then camera.aperture, camera.focus = w.lens.aperture, w.lens.focus end

-- A transparent material has no diffuse colour.
local function material(surface, fields)
  if surface.transmission then fields.ambient, fields.diffuse = 0, 0 end
  for name, value in pairs(surface) do
    if name ~= "lift" and name ~= "checker" then fields[name] = value end
  end
  if surface.checker then
    local even, odd = glint.vector(fields.diffuse), w.diffuse * glint.vector(surface.checker)
    fields.diffuse = glint.pattern(function(p) return glint.select(glint.checker(p), odd, even) end)
    fields.ambient = nil -- the ambient reflectance follows the diffuse reflectance
  end
  return glint.material(fields)
end

-- Makes a part of a CSG shape.
local function part(s)
  if s.kind == "ball" then return glint.sphere { center = s.center, radius = s.radius } end
  if s.kind == "box" then return glint.box { min = s.min, max = s.max } end
  if not s.parts then return glint[s.kind] { base = s.base, top = s.top, radius = s.radius } end
  local fields = {}
  for i, p in ipairs(s.parts) do fields[i] = part(p) end
  return glint[s.kind](fields)
end

-- Makes the shape that replaces a sphere.
local function shape(s, sphere, surface, coat)
  local center = { sphere[1][1], sphere[1][2] + (surface.lift or 0), sphere[1][3] }
  if not s then return glint.sphere { center = center, radius = sphere[2], material = coat } end
  if s.parts then
    local whole = part(s)
    whole.material = coat
    return whole
  end
  if s.kind == "box" then return glint.box { min = s.min, max = s.max, material = coat } end
  if s.kind == "mesh" then
    return glint.mesh { vertices = s.mesh.vertices, normals = s.mesh.normals, faces = s.mesh.faces, material = coat,
      shading = s.smooth and "phong" or "faceted", transform = s.scale and glint.scale(s.scale) }
  end
  if s.kind == "sphere" then
    return glint.sphere { center = { 0, 0, 0 }, radius = 1, material = coat,
      transform = glint.translate(center) * glint.scale(s.scale) }
  end
  if s.kind == "torus" then
    return glint.torus { center = s.center, axis = s.axis, major = s.major, minor = s.minor, material = coat }
  end
  return glint[s.kind] { base = s.base, top = s.top, radius = s.radius, capped = not s.open, material = coat }
end

-- With patterns, all materials have an ambient equal to the diffuse reflectance, so the ambient light is reduced.
local follows = P.surfaces == "checker"
local scene = glint.scene { camera = glint.camera(camera), ambient = follows and w.ambient / w.diffuse or 1, background = w.background }
if P.surfaces == "sky" then scene.background = glint.texture { file = P.sky, filter = "nearest", transfer = "linear" } end
for _, light in ipairs(lights[P.light]()) do scene:add(light) end
for i, sphere in ipairs(w.spheres) do
  local c, surface = sphere[3], (w.surfaces[P.surfaces] or {})[i] or {}
  scene:add(shape((w.shapes[P.surfaces] or {})[i], sphere, surface, material(surface, {
    model = P.model, shininess = w.shininess, specular = w.specular,
    ambient = not follows and { w.ambient * c[1], w.ambient * c[2], w.ambient * c[3] } or nil,
    diffuse = { w.diffuse * c[1], w.diffuse * c[2], w.diffuse * c[3] },
  })))
end
for _, more in ipairs(w.more[P.surfaces] or {}) do
  scene:add(glint.sphere { center = more.center, radius = more.radius, material = glint.material { ambient = 0, diffuse = 0,
    specular = more.specular, transmission = more.transmission, ior = more.ior, absorption = more.absorption } })
end
scene:render { width = 1280, height = 720, bits = 16, transfer = "linear", max_depth = w.depths[P.surfaces] or w.max_depth }
