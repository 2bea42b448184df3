-- The knobs of glint cost: a setting that trades accuracy for time is a row of the table at the end. Add a row for a
-- new stage; setting.c applies the value.
local the = ...
local format = string.format

-- Returns the values of a knob: the numbers in order, with the script's own number among them. own: its index.
local function numbers(own, ...)
  local values, at = { ... }, 1
  while values[at] and values[at] < own do at = at + 1 end
  if values[at] ~= own then table.insert(values, at, own) end
  values.own = at
  return values
end

-- As `numbers`. The truth is the largest value: with smaller ones the picture lacks light.
local function numbers_to_truth(...)
  local values = numbers(...)
  values.truth = #values
  return values
end

-- Returns the words, followed by the script's own word if it is none of them.
local function words(own, ...)
  local values = { ... }
  for i, word in ipairs(values) do
    if word == own then values.own = i end
  end
  if not values.own then
    values[#values + 1] = own
    values.own = #values
  end
  return values
end

-- Lists the shadows: soft ones for lights with a surface; also caps for sphere lights, if the scene allows caps. The
-- script's own value is the value of its first light with a surface.
local function list_shadows(study)
  if not study.stages.occlude then return end
  local first, caps
  for _, light in ipairs(study.lights) do
    first = first or light.is_soft and light
    caps = caps or (light.is_soft and light.is_sphere and study.takes_caps)
  end
  if not first then return words("hard", "off", "hard") end
  local own = first.shadow == "caps" and not caps and "soft" or first.shadow
  local values = words(own, "off", "hard", "soft", caps and "caps" or nil)
  values.truth = 3
  return values
end

-- The own value is the largest number of samples of any light. In its row, every light keeps its own number.
local function list_light_samples(study)
  local most = 0
  for _, light in ipairs(study.lights) do
    if light.is_soft then most = math.max(most, light.samples) end
  end
  return study.effects["soft shadow"] and numbers(most, 1, 4, 16, 64, 256)
end

-- Lists the models. matched_blinn_phong replaces every Phong highlight by a Blinn-Phong one with four times the
-- exponent, which is as wide. A scene with highlights of both models has its own setting "mixed".
local function list_model(study)
  local phong, blinn = study.effects["Phong highlight"], study.effects["Blinn-Phong highlight"]
  if phong then
    return words(blinn and "mixed" or "phong", "phong", "blinn_phong", "matched_blinn_phong")
  end
  return blinn and words("blinn_phong", "phong", "blinn_phong")
end

local TRIANGLES_MAX <const> = 0x1p21 -- limit of the triangles of all spheres together; no setting exceeds it

-- Lists the segments of spheres. The truth is the exact sphere, which the triangles approximate.
local function list_segments(study)
  local counts = {}
  for _, count in ipairs { 16, 64, 256, 1024 } do
    if count ^ 2 * study.globes <= TRIANGLES_MAX then counts[#counts + 1] = count end
  end
  if study.globes == 0 or not study.effects.triangles then return end
  local values = study.segments > 0 and numbers(study.segments, table.unpack(counts))
    or words("mixed", table.unpack(counts))
  values[#values + 1] = "exact"
  values.truth = #values
  return values
end

-- The materials count too, because a script with depth 0 has no stage for mirrors and glass.
local function list_max_depth(study)
  local own = study.max_depth
  return (study.stages.bounce or (own == 0 and study.stages.cast and study.has_bounce))
    and numbers_to_truth(own, 0, 1, 2, 5, 10)
end

-- 0, no limit, is the truth, and comes last.
local function list_clamp(study)
  if not study.stages.rough and not (study.stages.indirect and study.has_indirect) then return end
  local values = numbers(study.clamp > 0 and study.clamp or 1, 1, 4, 16)
  values[#values + 1] = 0
  values.truth = #values
  if study.clamp == 0 then values.own = #values end
  return values
end

-- The first is how the other rows render: a whole frame.
local function list_reuse(study)
  if not study.has_neighbour then return end
  local values = words("on", "off", "on")
  values.base = 1
  return values
end

-- ---- Effects that a value takes away ----

local function lose(low, other) return function(_, value) return (value == 0 or value == "off") and low or other end end

local function lose_depth(study, value)
  local rays = study.own.rays
  local name = rays.mirror > 0 and (rays.refraction > 0 and "reflections and refraction" or "reflections")
    or "refraction"
  return value == 0 and "without " .. name or "with fewer " .. name
end

local SURFACES <const>, PNG <const> = "a visible surface", "an output in .png"
local has_indirect = function(study) return study.stages.indirect and study.has_indirect end

-- In the order of the output. needs: what a scene needs to respond. list: returns the values, if the scene responds:
-- `own` is the index of the script's value, `base` of the value in the other knobs' rows (normally `own`), `truth` of
-- the value of the reference. is_of_file: its error arises in the file's pixel values, not in the linear light.
-- is_other_time: its times are not times of a whole frame. loses: names the effect that a value takes away, if the
-- picture shows that; nil: the knob changes the noise only.
the.knobs = {
  { name = "samples", needs = SURFACES,
    list = function(study) return study.stages.cast and numbers(study.samples, 1, 4, 16, 64) end },
  { name = "adaptive", needs = "several samples a pixel",
    list = function(study)
      return study.stages.cast and study.samples > 1 and numbers(study.adaptive, 0, 0.01, 0.03, 0.1, 0.3)
    end },
  { name = "shutter_times", needs = "an animation whose camera has an open shutter",
    loses = function(_, value) return value == 1 and "without motion blur" or "with coarser motion blur" end,
    list = function(study) return study.moments[1] and numbers_to_truth(table.unpack(study.moments)) end },
  { name = "shadows", needs = "a light that casts shadows", list = list_shadows,
    loses = lose("without shadows", "without sampled shadows") },
  { name = "light_samples", needs = "a light with a surface and soft shadows", list = list_light_samples },
  { name = "precision", needs = SURFACES, loses = lose(nil, "decided in float"),
    list = function(study) return study.stages.cast and words(study.precision, "double", "float") end },
  { name = "model", needs = "a highlight", list = list_model, loses = lose(nil, "with other highlights") },
  { name = "segments", needs = "a sphere_mesh", list = list_segments, loses = lose(nil, "with coarser spheres") },
  { name = "shading", needs = "a mesh and a light", loses = lose(nil, "with another shading"),
    list = function(study)
      return study.shading and study.stages.light and words(study.shading, "flat", "gouraud", "phong")
    end },
  { name = "max_depth", needs = "a mirror or glass", list = list_max_depth, loses = lose_depth },
  { name = "indirect_samples", needs = "indirect light",
    list = function(study) return has_indirect(study) and numbers(study.indirect_samples, 1, 4, 16, 64, 256) end },
  { name = "indirect_bounces", needs = "indirect light", -- 0 replaces indirect light by the ambient light
    loses = lose("without indirect light", "with fewer bounces"),
    list = function(study) return has_indirect(study) and numbers_to_truth(study.indirect_bounces, 0, 1, 2, 4, 8) end },
  { name = "ambient_occlusion_samples", needs = "ambient occlusion",
    list = function(study)
      return study.stages.indirect and study.has_ambient_occlusion
        and numbers(study.ambient_occlusion_samples, 1, 4, 16, 64, 256)
    end },
  { name = "reflection_samples", needs = "a rough surface that reflects",
    list = function(study) return study.stages.rough and numbers(study.reflection_samples, 1, 4, 16, 64, 256) end },
  { name = "clamp", needs = "indirect light or a rough surface that reflects", list = list_clamp,
    loses = function(_, value) return value > 0 and "with limited light of random paths" end },
  { name = "bits", needs = PNG, is_of_file = true,
    list = function(study) return not study.is_pfm and numbers(study.bits, 8, 16) end },
  { name = "encode", needs = PNG, is_alone = true,
    list = function(study) return not study.is_pfm and words(study.encode, "fast", "small") end },
  { name = "reuse", is_other_time = true, list = list_reuse,
    needs = "a second frame (in a loop of scene:render, choose a later frame than the first with --frame)" },
}

-- Refuses a list such as "samples,model" that names anything except knobs.
function the.check_knobs(list)
  local names, known = {}, {}
  for i, knob in ipairs(the.knobs) do names[i], known[knob.name] = knob.name, true end
  for name in list:gmatch "[^,]*" do
    if not known[name] then
      local near
      name = name:sub(1, 60)
      for _, other in ipairs(names) do near = the.nearer(name, near, other) end
      the.tools.refuse(format("--knobs: list of %s expected, got '%s'%s", table.concat(names, ", "), name,
        near and format("; did you mean '%s'?", near) or ""))
    end
  end
end
