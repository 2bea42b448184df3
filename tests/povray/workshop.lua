-- The workshop scene as plain numbers for both renderers: scene.lua passes it to glint, pov.lua writes it for
-- POV-Ray. All values stay below 1, as POV-Ray clips.

local function float(x) return (string.unpack("f", string.pack("f", x))) end

-- A wavy sheet facing eye and light, of 24 x 16 quads. POV-Ray stores corners and normals of meshes in float, and
-- turns normals that point away from the eye. scale: of a map that turns the result into this sheet.
local function sheet(scale)
  local s = scale or { 1, 1, 1 }
  local vertices, normals, faces, across, down = {}, {}, {}, 24, 16
  for j = 0, down do
    for i = 0, across do
      local u, v = i / across, j / down
      local x, y = -7 + 6 * u, 1 + 5 * (1 - v)
      local z = float(-2 + 5 * v + 0.35 * math.sin(7 * u) * math.cos(5 * v))
      local du = 0.35 * 7 * math.cos(7 * u) * math.cos(5 * v) / 6 -- derivatives of z with respect to x and y
      local dv = -(5 - 0.35 * 5 * math.sin(7 * u) * math.sin(5 * v)) / 5
      local l = math.sqrt(du * du + dv * dv + 1)
      local n = { -du / l * s[1], -dv / l * s[2], s[3] / l }
      l = math.sqrt(n[1] ^ 2 + n[2] ^ 2 + n[3] ^ 2)
      vertices[#vertices + 1] = { float(x / s[1]), float(y / s[2]), float(z / s[3]) }
      normals[#normals + 1] = { float(n[1] / l), float(n[2] / l), float(n[3] / l) }
      if i < across and j < down then
        local a = j * (across + 1) + i + 1
        faces[#faces + 1] = { a, a + across + 1, a + across + 2 }
        faces[#faces + 1] = { a, a + across + 2, a + 1 }
      end
    end
  end
  return { vertices = vertices, normals = normals, faces = faces }
end

return {
  eye = { 0, 6.2, 20.5 },
  at = { 0, 3.8, 0 },
  fov = 42, -- vertical field of view, in degrees
  height = 15, -- height of the orthographic view, in world units
  background = { 0.2, 0.3, 0.5 },
  sky = { -- for the surfaces `sky`: a panorama with red, green and blue at x, y from the top left, 0 .. 1
    width = 64, height = 32,
    color = function(x, y) return { 0.1 + 0.6 * x, 0.1 + 0.6 * y, 0.2 + 0.3 * ((64 * x // 4 + 32 * y // 4) % 2) } end,
  },
  light = { color = { 0.8, 0.75, 0.7 }, position = { 0, 20, 0 }, direction = { -3, -5, -2 } },
  spot = { inner = 8, outer = 14, direction = { 0.05, -1, 0.08 } }, -- a spot light there; in POV-Ray: radius, falloff
  fade = 15, -- distance at which the fall-off leaves the light unchanged
  grid = { side = 5, width = 4 }, -- an area light: side x side point lights
  ambient = 0.1, diffuse = 0.7, specular = 0.35, shininess = 128, -- values for every sphere
  max_depth = 16, -- largest depth at which both rays of a surface are traced
  shapes = { -- shapes that replace some of the spheres
    solids = {
      [2] = { kind = "box", min = { -4.5, 0, -7 }, max = { 1.5, 6, -2.5 } },
      [3] = { kind = "cylinder", base = { 5, 0.5, -1 }, top = { 7, 5, -2 }, radius = 1.8 },
      [4] = { kind = "sphere", scale = { 2.5, 1.5, 0.8 } },
      [5] = { kind = "cone", base = { 0.6, 0.25, 4.2 }, top = { 1.4, 4.5, 3.4 }, radius = 1.9 },
    },
    open = {
      [3] = { kind = "cylinder", base = { 5, 0.5, -1 }, top = { 6, 3.5, 2 }, radius = 1.8, open = true },
      [5] = { kind = "cone", base = { 0.2, 3.9, 5.6 }, top = { 0.9, 0.25, 4.2 }, radius = 1.9, open = true },
    },
    combined = {
      [2] = { kind = "difference", parts = {
        { kind = "box", min = { -4.5, 0.1, -7 }, max = { 1.5, 6, -2.5 } },
        { kind = "ball", center = { -1.5, 5, -3 }, radius = 2.6 },
        { kind = "cylinder", base = { -1.5, 2, -9 }, top = { -1.5, 2, 0 }, radius = 0.9 },
        { kind = "intersection", parts = {
          { kind = "ball", center = { -4.5, 3, -4 }, radius = 1.5 }, { kind = "box", min = { -9, 3, -9 }, max = { 9, 9, 9 } } } },
      } },
      [3] = { kind = "union", parts = {
        { kind = "ball", center = { 5.8, 3, -1 }, radius = 2 },
        { kind = "cylinder", base = { 3.2, 3, -1 }, top = { 8.4, 3, -0.5 }, radius = 1 },
        { kind = "cone", base = { 5.8, 4, -1 }, top = { 5.8, 7, -1 }, radius = 1.4 },
      } },
      [4] = { kind = "intersection", parts = {
        { kind = "difference", parts = {
          { kind = "ball", center = { -6.6, 2.5, 0.5 }, radius = 2.5 },
          { kind = "cylinder", base = { -8.6, 4.5, 4.5 }, top = { -5, 1, -3 }, radius = 1.1 } } },
        { kind = "box", min = { -8.6, 0.8, -1.5 }, max = { -4.6, 4.4, 2.4 } },
      } },
      [5] = { kind = "intersection", parts = {
        { kind = "ball", center = { 0.6, 2.4, 2.9 }, radius = 2.2 }, { kind = "ball", center = { 0.6, 2.4, 5.4 }, radius = 2.2 } } },
    },
    prism = {
      [2] = { kind = "box", min = { -4.5, 0.5, -6 }, max = { 0.5, 4.5, -2.5 } },
      [3] = { kind = "cylinder", base = { 5, 0.5, -1 }, top = { 7, 5, -2 }, radius = 1.8 },
    },
    rings = {
      [2] = { kind = "torus", center = { -1.2, 3.9, -4.5 }, axis = { 0.3, 0.4, 1 }, major = 2.9, minor = 0.9 },
      [3] = { kind = "torus", center = { 6, 2.7, -0.5 }, axis = { 1, 1, 0.3 }, major = 1.5, minor = 0.9 },
      [4] = { kind = "torus", center = { -5, 1.8, 1.5 }, axis = { -0.5, 1, 0.6 }, major = 2.2, minor = 0.12 },
      [5] = { kind = "torus", center = { 0.9, 2, 4.6 }, axis = { 0.1, -1, -0.5 }, major = 1.5, minor = 0.5 },
    },
    faceted = { [4] = { kind = "mesh", mesh = sheet() } },
    smooth = { [4] = { kind = "mesh", mesh = sheet(), smooth = true } },
    stretched = { [4] = { kind = "mesh", mesh = sheet { 2, 0.5, 4 }, smooth = true, scale = { 2, 0.5, 4 } } },
  },
  surfaces = { -- changes of some spheres, by number; `lift`: POV-Ray ignores hits nearer than 1e-3, and glass that
    -- stands on the ground shows that, enlarged
    plain = {},
    checker = { [2] = { checker = { 0.1, 0.2, 0.3 } }, [3] = { checker = { 0.1, 0.1, 0.1 } }, [4] = { checker = { 0.9, 0.9, 0.8 } } },
    sky = { [2] = { mirror = 0.5 }, [5] = { lift = 0.5, transmission = 0.8, ior = 1.5 } },
    translucent = { -- because POV-Ray does not dim highlights
      [2] = { opacity = 0.6, specular = 0 }, [3] = { opacity = 0.3, specular = 0 }, [5] = { lift = 0.5, opacity = 0.45, specular = 0 },
    },
    mirror = { [2] = { mirror = 0.5 }, [4] = { mirror = 0.3 } },
    glass = { [5] = { lift = 0.5, transmission = 0.8, ior = 1.5 }, [3] = { lift = 0.5, transmission = 0.6, ior = 1.2, mirror = 0.1 } },
    combined = { [5] = { transmission = 0.8, ior = 1.5, specular = 0 } },
    prism = { [2] = { transmission = 0.9, ior = 1.5, specular = 0 }, [3] = { transmission = 0.8, ior = 1.7, mirror = 0.1, specular = 0 } },
    rings = { [2] = { mirror = 0.4 }, [5] = { transmission = 0.8, ior = 1.3, specular = 0 } },
    nested = { [5] = { lift = 0.5, transmission = 0.9, ior = 1.5, specular = 0 } },
    absorbing = { [5] = { lift = 0.5, transmission = 0.9, ior = 1.5, absorption = 0.2, specular = 0 }, [2] = { mirror = 0.4 } },
    fresnel = { [5] = { lift = 0.5, transmission = 1, ior = 1.5, fresnel = true }, [3] = { lift = 0.5, transmission = 1, ior = 1.2, fresnel = true } },
  },
  more = { -- additional spheres of glass
    inside = { { center = { 0.4, 5.9, 21 }, radius = 1.5, transmission = 0.9, ior = 1.5, absorption = 0.2, specular = 0 } }, -- around the eye
    nested = { -- spheres nested in the fifth sphere, each with another index
      { center = { 0.8, 2.5, 4.3 }, radius = 1.3, transmission = 0.95, ior = 1.1, absorption = 0, specular = 0 },
      { center = { 0.7, 2.4, 4.5 }, radius = 0.7, transmission = 0.9, ior = 1.8, absorption = 0.1, specular = 0 },
    },
  },
  lens = { aperture = 0.6, focus = 17, blur_samples = 120 },
  depths = { nested = 14, prism = 14 }, -- max_depth for scenes that need another value
  spheres = { -- centre, radius, colour of each sphere
    { { 0, -10000, 0 }, 10000, { 0.45, 0.42, 0.40 } },
    { { -1.0, 4.0, -4.5 }, 4.0, { 0.70, 0.12, 0.10 } },
    { { 5.8, 3.0, -1.0 }, 3.0, { 0.85, 0.55, 0.10 } },
    { { -6.6, 2.5, 0.5 }, 2.5, { 0.10, 0.35, 0.62 } },
    { { 0.6, 2.0, 4.2 }, 2.0, { 0.16, 0.48, 0.20 } },
  },
}
