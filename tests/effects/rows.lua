--- The effects that a scene can use, one row each:
---   name       value of the parameter `effect` in scene.lua
---   part       in engine/render/stages/contract/with.h, omitted in a build without the effect; nil: it has no own kernel
---   stage, rays    its counter: the stage's name or the kind of ray in the events of --json;
---              nil: it has none
---   functions  Lua patterns of its functions' names; the effect calls at least one. {}: part of shared functions
---   file       the frame's file type, for effects of writing: functions of the whole program count, and without the
---              effect the file is a .png; nil: nothing is written, and only functions within tiles count
---   library    without which the effect is unavailable, as `glint --version --verbose` names it
---   call       makes the scene use the effect: receives glint, the scene's parts, and the scene
---   frame      the frame function of the script; receives the parts and the time
return {
  { name = "shadows", part = "SHADOW", stage = "occlude", rays = "shadow", functions = { "^occlude" },
    call = function(_, parts) parts.lamp.shadows = true end },
  { name = "mirrors", part = "BOUNCE", stage = "bounce", rays = "mirror", functions = { "bounce" },
    call = function(_, parts) parts.ball.mirror = 0.5 end },
  { name = "glass", part = "BOUNCE", stage = "bounce", rays = "refraction", functions = { "bounce", "glint_batch" },
    call = function(_, parts) parts.ball.transmission = 0.5 end },
  { name = "microfacets", part = "MICROFACET", stage = "facet", functions = { "facet", "^view_f" },
    call = function(_, parts)
      parts.ball.model = "cook_torrance"
      parts.ball.mirror = 0 -- lamps alone
    end },
  { name = "rough", part = "ROUGH", stage = "rough", rays = "mirror", functions = { "rough", "spread" },
    call = function(_, parts)
      parts.ball.mirror = 0.5
      parts.ball.roughness = 0.3
    end },
  { name = "blinn_phong", part = "BLINN", functions = {},
    call = function(_, parts) parts.ball.model = "blinn_phong" end },
  { name = "spot_light", part = "SPOT", functions = {},
    call = function(glint, parts, scene)
      scene:remove(parts.lamp)
      scene:add(glint.spot_light { position = { 0, 20, 0 }, direction = { 0, -1, 0 }, inner = 20, outer = 40,
        shadows = false })
    end },
  { name = "area_light", part = "AREA", functions = { "light_area", "^soft_light" },
    call = function(glint, parts, scene)
      scene:remove(parts.lamp)
      scene:add(glint.sphere_light { position = { 0, 20, 0 }, radius = 1, samples = 4, shadows = false })
    end },
  { name = "caps", part = "CAPS", functions = { "caps" },
    call = function(glint, parts, scene)
      scene:remove(parts.lamp)
      scene:add(glint.sphere_light { position = { 0, 20, 0 }, radius = 1, shadow = "caps" })
    end },
  { name = "mesh", part = "MESH", functions = { "triangle", "make_ray_edges" },
    call = function(glint, parts, scene)
      scene:add(glint.sphere_mesh { center = { 0, 5, 0 }, radius = 1, segments = 12, material = parts.ball })
    end },
  { name = "scan", part = "RASTER", functions = { "raster" }, options = "--visibility scan",
    call = function(glint, parts, scene)
      scene:add(glint.sphere_mesh { center = { 0, 5, 0 }, radius = 1, segments = 12, material = parts.ball })
    end },
  { name = "gouraud", part = "VERTEX_SHADING", stage = "vertex", functions = { "vertex" },
    call = function(glint, parts, scene)
      scene:add(glint.sphere_mesh { center = { 0, 5, 0 }, radius = 1, segments = 12, shading = "gouraud",
        material = parts.ball })
    end },
  { name = "solids", part = "SOLID", functions = { "solid", "span_of" },
    call = function(glint, parts, scene)
      scene:add(glint.box { min = { -1, 4, -1 }, max = { 1, 6, 1 }, material = parts.ball })
    end },
  { name = "combined", part = "COMBINED", functions = { "combined" },
    call = function(glint, parts, scene)
      scene:add(glint.union { glint.box { min = { -1, 4, -1 }, max = { 1, 6, 1 } }, material = parts.ball })
    end },
  { name = "indirect", part = "INDIRECT", stage = "indirect", rays = "indirect", functions = { "scatter" },
    call = function(_, _, scene) scene.indirect = { samples = 1, bounces = 1 } end },
  { name = "ambient_occlusion", part = "INDIRECT", stage = "indirect", rays = "indirect", functions = { "scatter", "open_sky" },
    call = function(_, _, scene) scene.ambient_occlusion = { samples = 1, distance = 5 } end },
  { name = "visible_light", stage = "visible_lights", functions = { "add_brightness" },
    call = function(glint, parts, scene)
      scene:remove(parts.lamp)
      scene:add(glint.sphere_light { position = { 0, 6, 0 }, radius = 1, samples = 4, visible = true })
    end },
  { name = "depth_cue", stage = "depth_cue", functions = { "take_faded" },
    call = function(_, _, scene) scene.depth_cue = { color = 0, near = 10, far = 30 } end },
  { name = "eye_in_glass", stage = "depth_cue", functions = { "take_faded" },
    call = function(glint, _, scene)
      scene:add(glint.plane { point = { 0, 1000, 0 }, normal = { 0, 1, 0 },
        material = glint.material { transmission = 1, ior = 1, absorption = 0.01 } })
    end },
  { name = "environment", part = "PROGRAM", stage = "environment", functions = { "put_directions" },
    call = function(glint, _, scene) scene.background = glint.pattern(function(d) return 0.5 + 0.25 * d.y end) end },
  { name = "pattern", part = "PROGRAM", stage = "pattern", functions = { "^program$", "glint_tile_pattern" },
    call = function(glint, parts) parts.ball.diffuse = glint.pattern(function(p) return glint.fract(p.y) end) end },
  { name = "shader", part = "PROGRAM", stage = "shader", functions = { "glint_tile_shader" },
    call = function(glint, parts)
      parts.ball.model = glint.shader(function(s) return s.kd * s.light * s.n:dot(s.l) end)
    end },
  { name = "bump", part = "PROGRAM", functions = { "turn_normals" },
    call = function(glint, parts)
      parts.ball.bump = glint.pattern(function(p) return 0.1 * glint.sin(9 * p.x) end)
    end },
  { name = "opacity", functions = { "glint_tile_find_holes" }, call = function(_, parts) parts.ball.opacity = 0 end },
  { name = "lens", part = "LENS", functions = { "camera_lens", "through_lens" },
    call = function(_, _, scene) scene.camera.aperture = 0.5 end },
  { name = "shutter", file = "png", functions = { "^glint_plan_create_exposed$", "^glint_shutter_desc$" },
    call = function(_, _, scene) scene.camera.shutter, scene.camera.shutter_times = 0.5, 2 end,
    frame = function(parts, t) parts.lamp.position = { 20 * t, 20, 0 } end },
  { name = "derivative", part = "DERIVATIVE", stage = "derivative", functions = { "^slope$", "glint_tile_derive" },
    options = "--passes d:strength",
    call = function(glint, parts) parts.lamp.intensity = glint.variable("strength", 1) end },
  { name = "samples", part = "SAMPLES", stage = "resolve", functions = { "^resolve" }, options = "--samples 4" },
  { name = "label", file = "png", functions = { "^glint_overlays_draw$", "^glint_stamps_row$", "^glint_letters_open$" },
    call = function(glint, _, scene) scene:add(glint.label { text = "t = 0" }) end },
  { name = "colorbar", file = "png", functions = { "^glint_colorbar_", "^glint_marks_" },
    call = function(glint, _, scene) scene:add(glint.colorbar { map = "magma", low = 0, high = 1 }) end },
  { name = "axes", file = "png", functions = { "^glint_axes_draw$", "^glint_layout_line$" },
    call = function(glint, _, scene) scene:add(glint.axes {}) end },
  { name = "axes_of_a_box", file = "png", functions = { "^glint_box_axes_draw$", "^glint_layout_line$" },
    call = function(glint, _, scene) scene:add(glint.axes { box = { { -8, -2, -3 }, { 7, 4, 4 } } }) end },
  { name = "arrow", file = "png", functions = { "^glint_layout_strokes$", "^glint_pointer_find$" },
    call = function(glint, _, scene) scene:add(glint.arrow { from = { 0, 0, 0 }, to = { 0, 6, 0 }, hidden = "dashed" }) end },
  { name = "colormap", file = "png", functions = { "^glint_colormap_table$" }, options = "--passes depth --colormap viridis" },
  { name = "npy", file = "npy", functions = { "^glint_npy_" } },
  { name = "exr", file = "exr", library = "OpenEXR", functions = { "^glint_exr_" } },
}
