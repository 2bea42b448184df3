-- Writes the workshop as a POV-Ray 3.7 scene to stdout:  lua5.4 pov.lua MODEL LIGHT PROJECTION WIDTH HEIGHT SURFACES SKY
--
-- Our formulas in POV-Ray's language (16-bit linear output: +FN16 File_Gamma=1.0, and no +A):
--   assumed_gamma 1.0, pigment { rgb C }, ambient_light rgb 1
--     pixel = ka C + sum over unoccluded lights with n.l > 0 of  Lc (kd C (n.l) + ks S);
--     the highlight is not multiplied by C, and nothing is divided by pi.
--   Phong        finish { phong ks phong_size n specular 0 }        S = (r.v)^n
--   Blinn-Phong  finish { specular ks roughness 1/n phong 0 }       S = (n.h)^n
--   camera       location E, direction f, right and up scaled to the view's width and height at distance 1, and neither
--                `angle` nor `look_at`; a pixel's ray goes through its centre. With f, r, u given, handedness is ours.
--   spot         light_source { position rgb c  spotlight radius INNER falloff OUTER tightness 0 point_at target }
--   fall-off     fade_distance d0 fade_power 2 is 2 / (1 + (d/d0)^2): attenuation = { 1/2, 0, 1/(2 d0^2) }
--   directional  light_source { far * -travel  rgb c  parallel  point_at 0 }
--   mirror       finish { reflection m }: adds m times the reflected ray's light
--   transmission pigment { rgb 0 transmit t } diffuse 0, interior { ior n }: t times the refracted ray's light; under
--                total reflection, the reflected ray's whole light, without `reflection`. Shadows: t at each surface,
--                no refraction.
--   opacity      pigment { rgb C transmit 1 - o }: o times ambient and diffuse light plus (1 - o) times the light
--                from straight behind; highlights and mirrors are not scaled there. Shadows: 1 - o at each surface
--   absorption   interior { fade_power 1001 fade_distance 1 fade_color 1 - a }: exp(-a length). POV-Ray absorbs only
--                refracted light: a highlight on the inside of the far surface reaches the eye undimmed. glint
--                absorbs it like all light on that path, so absorbing materials have no highlight in the test
--   fresnel      reflection { 0, 1 fresnel on } conserve_energy
--   shapes       box { min, max }; cylinder { base, top, r } and cone { base, r, top, 0 }, with `open` for capped = false;
--                an ellipsoid is sphere { 0, 1 scale s translate c }; torus { major, minor sturm } is around the y axis
--   sets         difference, intersection, and merge for union, which has no inner surfaces
--   mesh         mesh { triangle { a, b, c } } is faceted; mesh2 with normal_vectors is shading = "phong". POV-Ray
--                stores them in float. It flips normals that point away from the eye; glint flips those behind the face
--   checker      pigment { checker C, D }: D where floor(x) + floor(y) + floor(z) is odd, with coordinates 1e-10 larger
--   background   sky_sphere { pigment { image_map { map_type 1 } } }: the left edge is +x there and +z here,
--                with the same orientation; texels are not interpolated
--   lens         aperture 4 r (as measured: its rays start within a quarter of it), focal_point a point of the plane of
--                focus, blur_samples n variance 0. There all rays of a pixel go through its centre: compare blocks
--   max_depth    max_trace_level - 1, with adc_bailout 0, or weak rays are dropped
-- Shadow rays start at t > 1e-3 there, and at the surface here: pixels at shadow edges may differ.
local model, light, projection, width, height, surfaces, sky = table.unpack(arg)
local w = dofile "tests/povray/workshop.lua"

local function sub(a, b) return { a[1] - b[1], a[2] - b[2], a[3] - b[3] } end
local function scaled(a, s) return { a[1] * s, a[2] * s, a[3] * s } end
local function unit(a) return scaled(a, 1 / math.sqrt(a[1] ^ 2 + a[2] ^ 2 + a[3] ^ 2)) end
local function cross(a, b)
  return { a[2] * b[3] - a[3] * b[2], a[3] * b[1] - a[1] * b[3], a[1] * b[2] - a[2] * b[1] }
end
local function vector(a) return ("<%.17g, %.17g, %.17g>"):format(a[1], a[2], a[3]) end
local function line(format, ...) print(format:format(...)) end

local forward = unit(sub(w.at, w.eye))
local right = unit(cross(forward, { 0, 1, 0 }))
local up = cross(right, forward)
local extent = projection == "perspective" and 2 * math.tan(math.rad(w.fov) / 2) or w.height

line "#version 3.7;"
line("global_settings { assumed_gamma 1.0 ambient_light rgb 1 max_trace_level %d adc_bailout 0 }", (w.depths[surfaces] or w.max_depth) + 1)
if surfaces == "sky" then
  line('sky_sphere { pigment { image_map { png "%s" gamma 1.0 map_type 1 } rotate -90 * y } }', sky)
else
  line("background { rgb %s }", vector(w.background))
end
local lens = ""
if surfaces == "lens" then
  local e, f = w.eye, scaled(forward, w.lens.focus)
  lens = ("aperture %.17g focal_point %s blur_samples %d variance 0"):format(4 * w.lens.aperture,
    vector { e[1] + f[1], e[2] + f[2], e[3] + f[3] }, w.lens.blur_samples)
end
line("camera { %s location %s direction %s right %s up %s %s }", projection, vector(w.eye), vector(forward),
  vector(scaled(right, extent * width / height)), vector(scaled(up, extent)), lens)
if light == "point" then
  line("light_source { %s rgb %s }", vector(w.light.position), vector(w.light.color))
elseif light == "spot" then
  local p, d = w.light.position, w.spot.direction
  line("light_source { %s rgb %s spotlight radius %.17g falloff %.17g tightness 0 point_at %s }", vector(p),
    vector(w.light.color), w.spot.inner, w.spot.outer, vector { p[1] + d[1], p[2] + d[2], p[3] + d[3] })
elseif light == "fade" then
  line("light_source { %s rgb %s fade_distance %.17g fade_power 2 }", vector(w.light.position), vector(w.light.color),
    w.fade)
elseif light == "area" then
  local p, side, across = w.light.position, w.grid.side, w.grid.width
  for i = 0, side * side - 1 do
    local x, z = (i % side / (side - 1) - 0.5) * across, (i // side / (side - 1) - 0.5) * across
    line("light_source { %s rgb %s }", vector { p[1] + x, p[2], p[3] + z },
      vector(scaled(w.light.color, 1 / (side * side))))
  end
else
  local far = scaled(w.light.direction, -1e6)
  line("light_source { %s rgb %s parallel point_at 0 }", vector(far), vector(w.light.color))
end
local function highlight(s)
  local form = model == "phong" and "phong %.17g phong_size %.17g specular 0" or "specular %.17g roughness 1/%.17g phong 0"
  return form:format(s.specular or w.specular, w.shininess)
end
local function list(vectors)
  local texts = {}
  for i, v in ipairs(vectors) do texts[i] = vector(v) end
  return #vectors .. ", " .. table.concat(texts, ", ")
end
local function mesh(s)
  local texts, m = {}, s.mesh
  for i, f in ipairs(m.faces) do
    texts[i] = s.smooth and ("<%d, %d, %d>"):format(f[1] - 1, f[2] - 1, f[3] - 1)
      or ("triangle { %s, %s, %s }"):format(vector(m.vertices[f[1]]), vector(m.vertices[f[2]]), vector(m.vertices[f[3]]))
  end
  if not s.smooth then return "mesh { " .. table.concat(texts, " ") end
  return ("mesh2 { vertex_vectors { %s } normal_vectors { %s } face_indices { %d, %s } %s"):format(list(m.vertices),
    list(m.normals), #texts, table.concat(texts, ", "), s.scale and "scale " .. vector(s.scale) or "")
end

-- Returns the shape that replaces a sphere, up to its texture.
local function shape(s, center, radius)
  if not s then return ("sphere { %s, %.17g"):format(vector(center), radius) end
  if s.kind == "mesh" then return mesh(s) end
  if s.kind == "box" then return ("box { %s, %s"):format(vector(s.min), vector(s.max)) end
  if s.kind == "ball" then return ("sphere { %s, %.17g"):format(vector(s.center), s.radius) end
  if s.parts then
    local parts = {}
    for i, p in ipairs(s.parts) do parts[i] = shape(p) .. " }" end
    return (s.kind == "union" and "merge" or s.kind) .. " { " .. table.concat(parts, " ")
  end
  if s.kind == "sphere" then return ("sphere { 0, 1 scale %s translate %s"):format(vector(s.scale), vector(center)) end
  if s.kind == "torus" then
    local axis = unit(s.axis)
    local side = unit(cross(axis, { 0, 0, 1 }))
    local function numbers(a) return ("%.17g, %.17g, %.17g"):format(a[1], a[2], a[3]) end
    return ("torus { %.17g, %.17g sturm matrix <%s, %s, %s, %s>"):format(s.major, s.minor, numbers(side), numbers(axis),
      numbers(cross(side, axis)), numbers(s.center))
  end
  local open = s.open and "open" or ""
  if s.kind == "cone" then return ("cone { %s, %.17g, %s, 0 %s"):format(vector(s.base), s.radius, vector(s.top), open) end
  return ("cylinder { %s, %s, %.17g %s"):format(vector(s.base), vector(s.top), s.radius, open)
end

for i, sphere in ipairs(w.spheres) do
  local s = (w.surfaces[surfaces] or {})[i] or {}
  local center = { sphere[1][1], sphere[1][2] + (s.lift or 0), sphere[1][3] }
  local ambient, diffuse, pigment, interior = w.ambient, w.diffuse, "rgb " .. vector(sphere[3]), ""
  local finish = highlight(s) .. (s.mirror and (" reflection { rgb %.17g }"):format(s.mirror) or "")
  if s.fresnel then finish = finish .. " reflection { rgb 0, rgb 1 fresnel on } conserve_energy" end
  if s.checker then pigment = ("checker rgb %s, rgb %s"):format(vector(sphere[3]), vector(s.checker)) end
  if s.opacity then pigment = pigment .. (" transmit %.17g"):format(1 - s.opacity) end
  if s.transmission then
    ambient, diffuse, pigment = 0, 0, ("rgb 0 transmit %.17g"):format(s.transmission)
    local a = s.absorption
    interior = ("interior { ior %.17g %s }"):format(s.ior, a and
      ("fade_power 1001 fade_distance 1 fade_color rgb %.17g"):format(1 - a) or "")
  end
  line("%s pigment { %s } finish { ambient %.17g diffuse %.17g %s } %s }",
    shape((w.shapes[surfaces] or {})[i], center, sphere[2]), pigment, ambient, diffuse, finish, interior)
end
for _, a in ipairs(w.more[surfaces] or {}) do
  line("sphere { %s, %.17g pigment { rgb 0 transmit %.17g } finish { ambient 0 diffuse 0 %s }", vector(a.center), a.radius,
    a.transmission, highlight(a))
  line("interior { ior %.17g fade_power 1001 fade_distance 1 fade_color rgb %.17g } }", a.ior, 1 - a.absorption)
end
