-- The workshop scene as plain numbers, for both renderers: scene.lua hands it to glint, pov.lua writes it for POV-Ray.
-- All values stay below 1, since POV-Ray clips.
return {
  eye = { 0, 6.2, 20.5 },
  at = { 0, 3.8, 0 },
  fov = 42, -- degrees, vertical
  height = 15, -- world units, of the orthographic view
  background = { 0.2, 0.3, 0.5 },
  light = { color = { 0.8, 0.75, 0.7 }, position = { 0, 20, 0 }, direction = { -3, -5, -2 } },
  spot = { inner = 8, outer = 14, direction = { 0.05, -1, 0.08 } }, -- at the light's place; POV-Ray: radius, falloff
  fade = 15, -- distance at which the light is as strong as without fall-off
  grid = { side = 5, width = 4 }, -- an area light: side x side point lights
  ambient = 0.1, diffuse = 0.7, specular = 0.35, shininess = 128, -- of every sphere
  max_depth = 20,
  surfaces = { -- what becomes of some of the spheres, by number; `lift`: POV-Ray sees no hit nearer than 1e-3, and glass that
    -- stands on the ground shows that, enlarged
    plain = {},
    mirror = { [2] = { mirror = 0.5 }, [4] = { mirror = 0.3 } },
    glass = { [5] = { lift = 0.5, transmission = 0.8, ior = 1.5 }, [3] = { lift = 0.5, transmission = 0.6, ior = 1.2, mirror = 0.1 } },
    absorbing = { [5] = { lift = 0.5, transmission = 0.9, ior = 1.5, absorption = 0.2 }, [2] = { mirror = 0.4 } },
    fresnel = { [5] = { lift = 0.5, transmission = 1, ior = 1.5, fresnel = true }, [3] = { lift = 0.5, transmission = 1, ior = 1.2, fresnel = true } },
  },
  spheres = { -- center, radius, colour
    { { 0, -10000, 0 }, 10000, { 0.45, 0.42, 0.40 } },
    { { -1.0, 4.0, -4.5 }, 4.0, { 0.70, 0.12, 0.10 } },
    { { 5.8, 3.0, -1.0 }, 3.0, { 0.85, 0.55, 0.10 } },
    { { -6.6, 2.5, 0.5 }, 2.5, { 0.10, 0.35, 0.62 } },
    { { 0.6, 2.0, 4.2 }, 2.0, { 0.16, 0.48, 0.20 } },
  },
}
