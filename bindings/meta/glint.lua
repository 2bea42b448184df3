---@meta glint

-- The whole API of glint for editors (LuaLS). tests/lua/check_meta.lua checks that it equals what the module registers.
--
-- Lengths are in world units, the world is right-handed, angles are in degrees. Colours are linear, 1 = display white.
-- A wrong name, type or value raises an error such as
--     scene.lua:7: material.shininess: number >= 0 expected, got -1
-- Strings do not count as numbers. NaN and infinity are refused wherever a quantity is expected.

---@class glint
---@field version string  "major.minor.patch"
local glint = {}

-- ---- Values ----

--- Three numbers, immutable. To change a vector of an object, assign a whole one (`lamp.position = {0, 20, 0}`), or
--- one component if the object has a position (`lamp.x = 3`). `a + b`, `a - b`, `a * b`, `a / b`, `a % b`, `a // b`,
--- `a ^ b` and `-a` work by component; one side may be a number. An array `{x, y, z}` may replace a vector. `#v` is
--- 3; `==` compares the numbers.
---@class glint.vector
---@field x number  also v[1]
---@field y number  also v[2]
---@field z number  also v[3]
---@field r number  the same as x
---@field g number  the same as y
---@field b number  the same as z
---@field u number  the same as x, of s.uv
---@field v number  the same as y, of s.uv
---@field [integer] number
---@operator add(glint.vec3|number): glint.vector
---@operator sub(glint.vec3|number): glint.vector
---@operator mul(glint.vec3|number): glint.vector
---@operator div(glint.vec3|number): glint.vector
---@operator mod(glint.vec3|number): glint.vector
---@operator idiv(glint.vec3|number): glint.vector
---@operator pow(glint.vec3|number): glint.vector
---@operator unm: glint.vector
local vector = {}

---@return number x
---@return number y
---@return number z
function vector:unpack() end

---@param b glint.values
---@return number
function vector:dot(b) end

---@param b glint.values
---@return glint.vector
function vector:cross(b) end

---@return number
function vector:length() end

--- Returns the vector divided by its length.
---@return glint.vector
function vector:unit() end

--- Reflects an incident direction in a mirror with the unit normal n: d - 2 (n.d) n.
---@param n glint.values
---@return glint.vector
function vector:reflect(n) end

--- A vector, or an array of exactly three numbers. Read from an object it is always a vector.
---@alias glint.vec3 glint.vector|number[]

--- {r, g, b} or one number, linear; "#rgb", "#rrggbb" or one of the 148 CSS names, sRGB, converted to linear.
--- Read from an object it is always a vector.
---@alias glint.color glint.vector|number[]|number|string

---@class glint.object
---@field kind string  "sphere", "point_light", "label", "material" ...: the function that makes such objects; read-only
local any_object = {}

--- Releases the object now instead of when it is collected. Shapes and scenes that use it keep it.
function any_object:close() end

---@class glint.placed
---@field x number  the x coordinate of `position` or `center`
---@field y number  the y coordinate
---@field z number  the z coordinate

-- ---- Materials ----

---@class glint.material_fields
---@fields material

---@class glint.material: glint.material_fields, glint.object
local material = {}

---@class glint.geometry
---@field normal glint.vec3  surface normal, on the eye's side
---@field to_light glint.vec3  from the point to the light
---@field to_eye glint.vec3  from the point to the eye
---@field p? glint.vec3  the point, read by patterns and shaders of the material; bumps are ignored. Default {0, 0, 0}

---@class glint.reflection
---@field diffuse glint.vector  kd (n.l); 0 if n.l <= 0
---@field specular glint.vector  ks S, where S is (r.v)^shininess or the term of another `model`; 0 if n.l <= 0

--- The two terms for one light of strength 1, computed by the kernels of a frame. The vectors need not be unit.
---@param geometry glint.geometry
---@return glint.reflection
function material:evaluate(geometry) end

---@param fields glint.material_fields
---@return glint.material
function glint.material(fields) end

-- ---- Lights ----

--- Each light adds A * V * (kd * diffuse * (n.l) + ks * specular * S) where n.l > 0, with V = 0 in shadow.
---@class glint.point_light_fields
---@fields point_light

---@class glint.point_light: glint.point_light_fields, glint.object, glint.placed

---@param fields glint.point_light_fields
---@return glint.point_light
function glint.point_light(fields) end

---@class glint.directional_light_fields
---@fields directional_light

---@class glint.directional_light: glint.directional_light_fields, glint.object

---@param fields glint.directional_light_fields
---@return glint.directional_light
function glint.directional_light(fields) end

---@class glint.spot_light_fields
---@fields spot_light

---@class glint.spot_light: glint.spot_light_fields, glint.object, glint.placed

---@param fields glint.spot_light_fields
---@return glint.spot_light
function glint.spot_light(fields) end

--- Lights with a surface have soft shadows. With `intensity`, a light adds the mean of point lights all over its
--- surface; with `radiance` L, the integral of L cos cos' / distance^2 over its surface, instead of A V (n.l).
---@class glint.disk_light_fields
---@fields disk_light

---@class glint.disk_light: glint.disk_light_fields, glint.object, glint.placed

---@param fields glint.disk_light_fields
---@return glint.disk_light
function glint.disk_light(fields) end

---@class glint.polygon_light_fields
---@fields polygon_light

---@class glint.polygon_light: glint.polygon_light_fields, glint.object

---@param fields glint.polygon_light_fields
---@return glint.polygon_light
function glint.polygon_light(fields) end

---@class glint.sphere_light_fields
---@fields sphere_light

---@class glint.sphere_light: glint.sphere_light_fields, glint.object, glint.placed

---@param fields glint.sphere_light_fields
---@return glint.sphere_light
function glint.sphere_light(fields) end

-- ---- Arrays ----

--- A block of numbers in rows; each row has one number, or `width` numbers. Reading and writing beyond the rows raises, only
--- a[#a + 1] is nil. `a + b`, `a - b`, `a * b`, `a / b` and `-a` work by element: b is an array of the same size, a number, or one number for
--- each column.
---@class glint.array
---@field [integer] number|glint.vector|number[]  a row: a number; of three numbers a vector; otherwise a list
---@field width integer  numbers of a row; read-only
---@field x glint.array  a copy of the first column; read-only, as y and z are, and r, g, b for the same columns
---@field y glint.array
---@field z glint.array
---@field r glint.array
---@field g glint.array
---@field b glint.array
---@operator add(any): glint.array
---@operator sub(any): glint.array
---@operator mul(any): glint.array
---@operator div(any): glint.array
---@operator unm: glint.array
local array = {}

--- Returns the rows with these numbers, in their order.
---@param rows glint.array  integers
---@return glint.array
function array:at(rows) end

--- Returns which of `count` equal parts of low .. high each number is in, from 1: the nearest one beyond them, count + 1 for NaN.
---@param low number
---@param high number
---@param count integer
---@return glint.array
function array:bins(low, high, count) end

--- Returns a copy of a column.
---@param number integer  1 .. width
---@return glint.array
function array:column(number) end

--- Returns how often each whole number occurs, by number.
---@return table<integer, integer>
function array:counts() end

--- Returns the greatest whole numbers that are not above the numbers.
---@return glint.array
function array:floor() end

--- Returns the results of a pattern, or of a function that could be one, for all rows. The function has the number, or the
--- row of two or three columns as a point.
---@param f glint.pattern|fun(x: any): any
---@return glint.array
function array:map(f) end

--- Returns the largest number, or one for each column. Leaves out NaN.
---@return number|glint.vector|number[]
function array:max() end

--- Returns the mean, or one for each column.
---@return number|glint.vector|number[]
function array:mean() end

--- Returns the smallest number, or one for each column. Leaves out NaN.
---@return number|glint.vector|number[]
function array:min() end

--- Returns a copy of some rows.
---@param first? integer  negative: from the end. Default 1
---@param last? integer  negative: from the end. Default #array
---@param step? integer  Default 1
---@return glint.array
function array:slice(first, last, step) end

--- Returns the sum, or one for each column; of numbers with the terms that plain addition loses.
---@return number|glint.vector|number[]
function array:sum() end

--- Returns a list of all rows.
---@return table
function array:table() end

--- Makes an array of a list of numbers or rows, of arrays of one column, which become its columns, or of zeros.
---@param from number[]|number[][]|glint.array[]|integer  integer: the number of zeros
---@param kind? "number"|"integer"  Default "number": double precision
---@return glint.array
function glint.array(from, kind) end

-- ---- Camera ----

---@class glint.camera_fields
---@fields camera

---@class glint.camera: glint.camera_fields, glint.object
local camera = {}

--- Returns where a picture of width x height pixels shows a point, even if it is hidden: x and y in pixels from the
--- upper left corner, where the first pixel's centre is 0.5, 0.5, and the depth as in the pass `depth`. nil: the point
--- is not in front of the camera.
---@param point glint.vec3  world units
---@param width number  pixels
---@param height number  pixels
---@return number? x, number? y, number? depth
function camera:project(point, width, height) end

---@param fields glint.camera_fields
---@return glint.camera
function glint.camera(fields) end

-- ---- Shapes ----

---@class glint.shape_fields
---@fields spheres

---@alias glint.shape glint.sphere|glint.plane|glint.spheres|glint.mesh|glint.box|glint.disk|glint.cylinder|glint.cone|glint.torus|glint.cylinders|glint.group|glint.union|glint.intersection|glint.difference

--- An affine map, immutable. `a * b` applies b first, then a; `a * {x, y, z}` is the image of a point. Maps are equal
--- when all their numbers are. `a[1]` to `a[12]` are the numbers that glint.matrix takes.
---@class glint.transform
---@operator mul(glint.transform): glint.transform
---@operator mul(glint.vec3): glint.vector
---@field [integer] number  1 .. 12, row by row

--- translate(x, y, z) or translate {x, y, z}.
---@param x number|glint.vec3
---@param y? number
---@param z? number
---@return glint.transform
function glint.translate(x, y, z) end

--- Rotates counter-clockwise, seen with the axis pointing at the eye; quarter turns are exact.
---@param axis "x"|"y"|"z"|glint.vec3  not zero, need not be unit
---@param degrees number
---@return glint.transform
function glint.rotate(axis, degrees) end

--- scale(s) or scale(x, y, z) or scale {x, y, z}; no factor may be 0.
---@param x number|glint.vec3
---@param y? number
---@param z? number
---@return glint.transform
function glint.scale(x, y, z) end

--- 12 numbers row by row (x' = m1 x + m2 y + m3 z + m4, ...), or 16 with 0, 0, 0, 1 as the last four.
---@param numbers number[]
---@return glint.transform
function glint.matrix(numbers) end
---@alias glint.light glint.point_light|glint.directional_light|glint.spot_light|glint.area_light
---@alias glint.area_light glint.disk_light|glint.polygon_light|glint.sphere_light

---@class glint.sphere_fields
---@fields sphere

---@class glint.sphere: glint.sphere_fields, glint.object, glint.placed

---@param fields glint.sphere_fields
---@return glint.sphere
function glint.sphere(fields) end

---@class glint.plane_fields
---@fields plane

---@class glint.plane: glint.plane_fields, glint.object

---@param fields glint.plane_fields
---@return glint.plane
function glint.plane(fields) end

--- Many spheres in one shape, copied once.
---@class glint.spheres_fields: glint.shape_fields
---@field data glint.array|number[]|string  x, y, z, radius of each sphere: an array with four columns or one, a flat table, or packed numbers in native byte order
---@field format? "f32"|"f64"  number format of packed data; required for packed data, otherwise refused
---@field materials? glint.material[]  instead of `material`, with `index`
---@field index? glint.array|integer[]|string  which of `materials` each sphere has, from 1: an array of integers, a table, or packed u32 numbers

---@class glint.spheres: glint.shape_fields, glint.object
---@field count integer  number of spheres; read-only
---@field data glint.array  a copy of the numbers, a row x, y, z, radius for each sphere; read-only
---@field index glint.array?  the number of each sphere's material in `materials`; nil: all have the first; read-only
---@field materials glint.material[]  a new list of the materials; read-only
---@field min glint.vector  the corner of the smallest coordinates of the box around the spheres, before the transform; read-only
---@field max glint.vector  the corner of the largest coordinates; read-only

---@param fields glint.spheres_fields
---@return glint.spheres
function glint.spheres(fields) end

--- Many cylinders in one shape, copied once. Their patterns read p, not uv.
---@class glint.cylinders_fields: glint.shape_fields
---@field data glint.array|number[]|string  base, top and radius of each cylinder, 7 numbers, in the forms that spheres have
---@field format? "f32"|"f64"  as for spheres
---@field capped? boolean  closed at both ends. Default true
---@field materials? glint.material[]  as for spheres
---@field index? glint.array|integer[]|string  as for spheres

---@class glint.cylinders: glint.shape_fields, glint.object
---@field capped boolean  closed at both ends
---@field count integer  number of cylinders; read-only
---@field data glint.array  a copy of the numbers, a row of 7 for each cylinder; read-only
---@field index glint.array?  as for spheres; read-only
---@field materials glint.material[]  a new list of the materials; read-only
---@field min glint.vector  as of spheres; read-only
---@field max glint.vector  as of spheres; read-only

---@param fields glint.cylinders_fields
---@return glint.cylinders
function glint.cylinders(fields) end

---@alias glint.shading
---| "faceted"  # shaded per sample, with the normal of the face
---| "phong"  # shaded per sample, with a normal interpolated from the vertices, in the mesh's own space (without `normals`, a vertex has the mean normal of the faces around it); shadows are computed with the flat faces, see `terminator`
---| "flat"  # shaded once per face, at its centroid
---| "gouraud"  # shaded once per vertex, with its normal; interpolated by barycentric coordinates

--- Polygons that share vertices, from tables or from a file, .obj, .stl or .ply; copied once. Give `file`, or
--- `vertices` and `faces`. Concave faces are triangulated; faces that cross themselves are refused.
---@class glint.mesh_fields: glint.shape_fields
---@field file? string  a mesh, relative to the working directory: .stl (without `material` also VisCAM's colours); .ply (without `material` also its colours, with one material for each colour); else a Wavefront .obj (v, vt, vn, f, s; without `material` also usemtl and mtllib: Kd, Ks, Ns, d or Tr, map_Kd, map_Ks, map_d, map_Bump with -bm)
---@field vertices? glint.vec3[]|number[]|string  positions: a list of {x, y, z}, a flat table or packed numbers
---@field faces? integer[][]|integer[]|glint.array|string  indices of vertices, from 1: a list for each face, with any number of corners, counter-clockwise seen from the front; or triangles as an array of three integers a row, a flat table or packed u32 numbers
---@field normals? glint.vec3[]|number[]|string  one per vertex, or one per corner in the order of the faces; not zero, need not be unit
---@field uv? number[][]|number[]|string  u, v for s.uv and textures, one pair per vertex, or one per corner in the order of the faces; a file stores them as `vt`
---@field format? "f32"|"f64"  number format of packed vertices, normals and uv; required for packed data, otherwise refused
---@field materials? glint.material[]  instead of `material`, with `index`
---@field index? integer[]|string  which of `materials` each face has, from 1: a table, or packed u32 numbers
---@field shading? glint.shading  Default "phong" with normals, else "faceted"
---@field terminator? number  0 .. 1, for phong shading: 1 moves points outwards to the curved surface before light and shadow are computed, so that the terminator has no steps. Not with `transmission`, a translucent `opacity` or in combined solids. Default 0

---@class glint.mesh: glint.shape_fields, glint.object
---@field shading glint.shading
---@field terminator number  0 .. 1
---@field count integer  number of triangles; read-only
---@field vertices glint.array  a copy of the vertices, a row x, y, z for each, before the transform; read-only
---@field faces glint.array  the triangles, a row of three numbers of vertices for each; faces with more corners are cut; read-only
---@field normals glint.array?  the given normals, of length 1: a row for each vertex, or for each corner of the triangles; { 0, 0, 0 } where a file has none; nil without normals; read-only
---@field uv glint.array?  the texture coordinates u, v in the same order; nil: there are none; read-only
---@field index glint.array?  the number of each triangle's material in `materials`; nil: all have the first; read-only
---@field materials glint.material[]  all materials; for a mesh from a file, the materials that its faces use. The list is read-only, but the fields of its materials can be set
---@field min glint.vector  the corner of the smallest coordinates of the box around the vertices, before the transform; read-only
---@field max glint.vector  the corner of the largest coordinates; read-only

---@param fields glint.mesh_fields
---@return glint.mesh
function glint.mesh(fields) end

---@class glint.sphere_mesh_fields: glint.shape_fields
---@field center glint.vec3  world units
---@field radius number  world units, > 0; the vertices are on the sphere
---@field segments integer  number of segments around the equator, 3 to 16384; from pole to pole there are half as many
---@field shading? glint.shading  Default "phong", with the sphere's own normals at the vertices
---@field terminator? number  see `glint.mesh`

--- A mesh that approximates a sphere, to compare with the exact one.
---@param fields glint.sphere_mesh_fields
---@return glint.mesh
function glint.sphere_mesh(fields) end

---@class glint.box_fields
---@fields box

---@class glint.box: glint.box_fields, glint.object

---@param fields glint.box_fields
---@return glint.box
function glint.box(fields) end

---@class glint.disk_fields
---@fields disk

---@class glint.disk: glint.disk_fields, glint.object, glint.placed

---@param fields glint.disk_fields
---@return glint.disk
function glint.disk(fields) end

---@class glint.cylinder_fields
---@fields cylinder

---@class glint.cylinder: glint.cylinder_fields, glint.object

---@param fields glint.cylinder_fields
---@return glint.cylinder
function glint.cylinder(fields) end

---@class glint.cone_fields
---@fields cone

---@class glint.cone: glint.cone_fields, glint.object

---@param fields glint.cone_fields
---@return glint.cone
function glint.cone(fields) end

---@class glint.torus_fields
---@fields torus

---@class glint.torus: glint.torus_fields, glint.object, glint.placed

---@param fields glint.torus_fields
---@return glint.torus
function glint.torus(fields) end

---@class glint.group_fields
---@fields group
---@field [integer] glint.shape  the shapes and groups in the group

--- Shapes under one transform. A shape or group may be in several groups and scenes. It appears in each, and changes
--- to it apply everywhere. Groups nest at most 64 deep. A group cannot contain itself.
---@class glint.group: glint.object
---@fields group
---@field count integer  number of shapes and groups in the group, as #group; read-only
---@field [integer] glint.shape  the shapes and groups, from 1
local group = {}

--- Adds a shape or group and returns it.
---@param shape glint.shape
---@return glint.shape
function group:add(shape) end

---@param shape glint.shape
function group:remove(shape) end

--- Returns a new list of the shapes and groups in the group.
---@return glint.shape[]
function group:objects() end

---@param fields glint.group_fields
---@return glint.group
function glint.group(fields) end

---@class glint.combined_fields: glint.shape_fields
---@field [integer] glint.shape  the parts: spheres, boxes, capped cylinders and cones, tori, planes, closed meshes, combined solids and groups of these

---@class glint.combined: glint.combined_fields, glint.object
---@field count integer  number of the given parts; read-only
---@field [integer] glint.shape  the parts, from 1
local combined = {}

--- Adds a part and returns it.
---@param shape glint.shape
---@return glint.shape
function combined:add(shape) end

---@param shape glint.shape
function combined:remove(shape) end

--- Returns a new list of the parts.
---@return glint.shape[]
function combined:objects() end

--- Everything inside any of its 1 .. 64 parts, as one solid (a torus counts twice, a closed mesh four times). A plane
--- is the half-space behind it; a group is everything inside its shapes. A part shows only on the boundary of the
--- solid, with its own material or, without one, the solid's. The solid's material defaults to the first material of
--- the parts. Its `ior` and `absorption` apply inside. The solid is one object. `two_sided` of parts has no effect.
---@class glint.union: glint.combined

---@param fields glint.combined_fields
---@return glint.union
function glint.union(fields) end

--- Everything inside all parts.
--- See glint.union for parts, their materials and the inside.
---@class glint.intersection: glint.combined

---@param fields glint.combined_fields
---@return glint.intersection
function glint.intersection(fields) end

--- Everything inside the first part and outside the others. If another part ends exactly at a face of the first part,
--- the solid is open at that face. See glint.union for parts, their materials and the inside.
---@class glint.difference: glint.combined

---@param fields glint.combined_fields
---@return glint.difference
function glint.difference(fields) end

-- ---- Overlays: labels, colour bars, axes, arrows ----

--- Drawn over a finished picture: in .png files of beauty, and as vectors in .svg and .pdf; not in other passes and not in .pfm, .npy and .exr.
--- Lengths in points are dpi / 72 pixels if `dpi` is set, otherwise pixels.
---@class glint.overlay_fields
---@field at? "top left"|"top"|"top right"|"left"|"center"|"right"|"bottom left"|"bottom"|"bottom right"|number[]  position in the picture, or {x, y} as shares of the free space within the margin. Default for a label "top left", a colour bar "right", axes "bottom left"
---@field position? number[]  {x, y} of its upper left corner, in pixels from the upper left corner of the picture; instead of `at`
---@field size? number  size of its letters, points, 1 .. 10000. Default nil: 1/36 of the picture's height, at least 10 pixels
---@field margin? number  distance from the picture's border, points. Default nil: half of `size`
---@field color? glint.color  colour of letters and lines, without the tone curve. Default 1
---@field background? glint.color  colour of a rectangle behind the overlay. Default nil: none
---@field opacity? number  opacity of the background, 0 .. 1. Default 1
---@field name? string  for messages, at most 63 bytes. Default ""

---@class glint.label_fields: glint.overlay_fields
---@field text string  UTF-8, lines divided by newlines, at most 383 bytes; "" shows nothing. Parts between two $ are formulas, a subset of TeX
---@field at_point? glint.vec3  a point in the world next to which the label is drawn, instead of `at`; `margin` is the distance from the point. Default nil
---@field hidden? "drawn"|"none"  whether the label is drawn if a surface hides `at_point`. Default "drawn"

--- A text over the picture. A label set in frame(t) changes the picture's key, but nothing is rendered again for it.
---@class glint.label: glint.label_fields, glint.object

---@param fields glint.label_fields
---@return glint.label
function glint.label(fields) end

---@class glint.colorbar_fields: glint.overlay_fields
---@field map "viridis"|"magma"|"cividis"|"turbo"|"coolwarm"|glint.color[]|fun(share: number): glint.color  as in glint.colormap; a function is called when the bar is made, and the field then reads as a list of colours
---@field low number  the value of the first colour
---@field high number  the value of the last colour; different from low
---@field title? string  text above the bar, as in a label. Default ""
---@field ticks? number[]  1 .. 16 numbers written next to the bar, from low to high. Default nil: as many round numbers as fit
---@field scale? "linear"|"log"  as in glint.colormap. Default "linear"
---@field orientation? "vertical"|"horizontal"  Default "vertical", low at the bottom
---@field length? number  length of the bar, points. Default nil: 10 times `size`

---@class glint.colorbar: glint.colorbar_fields, glint.object

---@param fields glint.colorbar_fields
---@return glint.colorbar
function glint.colorbar(fields) end

---@class glint.series
---@field y number[]|glint.array|fun(x: number): number  one number for each x, or a function that is called with each x when the series is read. NaN is a gap
---@field x? number[]|glint.array  Default: the chart's x; without one 1, 2, 3 ...
---@field label? string  text at the end of the curve, in its colour, at most 127 bytes. Default ""
---@field color? glint.color  Default: one of eight colours, by the series' number
---@field width? number  thickness of the line, points, 0 .. 1000; 0: no line. Default nil: about a seventh of `size`
---@field dots? boolean  a dot at each point. Default false

---@class glint.chart_fields: glint.overlay_fields
---@field series? glint.series[]  1 .. 16 curves; reads as a copy
---@field y? number[]|fun(x: number): number  a single curve, instead of `series`; only in glint.chart { ... }
---@field x? number[]|glint.array  the x of all series that have none of their own; only in glint.chart { ... }
---@field labels? string[]  the labels of the series that have none of their own; only in glint.chart { ... }
---@field title? string  text above the curves, as in a label. Default ""
---@field x_label? string  name of the horizontal axis, at most 127 bytes. Default ""
---@field y_label? string  name of the vertical axis. Default ""
---@field x_scale? "linear"|"log"  with "log" every x is above 0. Default "linear"
---@field y_scale? "linear"|"log"  Default "linear"
---@field x_range? number[]  {first, last}; curves are cut there. Default nil: the range of the points
---@field y_range? number[]  {first, last}. Default nil: the range of the points, with a little space
---@field extent? number[]  {width, height} of the chart with its numbers and names, points. Default nil: the picture inside the margin

--- Curves over a grid, with numbers and names along two axes. Each label is at the end of its curve. Default `color`
--- 0.02, `background` 1 and `at` "center": a chart on white paper. A script may
--- return a chart; a scene with a chart and no shapes needs no camera.
---@class glint.chart: glint.chart_fields, glint.object
---@field save fun(self: glint.chart, path: string, options?: { width?: integer, height?: integer, dpi?: number }): boolean?, string?  writes the chart as a picture, as image:save does, 640 x 400 pixels by default

---@param fields glint.chart_fields
---@return glint.chart
function glint.chart(fields) end

---@class glint.axes_fields: glint.overlay_fields
---@field labels? string[]  names of x, y and z, as the text of a label, at most 63 bytes each. Default {"x", "y", "z"}
---@field length? number  length of an axis parallel to the picture plane, points. Default nil: 2.5 times `size`
---@field box? glint.vec3[]|table  {lowest corner, highest corner} in the world, a box { low, size, xy, xz, yz } or a cell { origin, a, b, c }: the axes are then drawn with numbers along edges of the box; replaces `at`, `position`, `margin`, `length` and `background`. Default nil
---@field values? glint.vec3[]  the numbers at those two corners. Default nil: world coordinates; for a tilted cell, lengths along its sides

--- The directions x (red), y (green) and z (blue) in the camera's view. With a `box`: three edges of its visible
--- outline, with ticks, round numbers and names; none for a direction along the view.
---@class glint.axes: glint.axes_fields, glint.object

---@param fields glint.axes_fields
---@return glint.axes
function glint.axes(fields) end

---@class glint.curve_fields
---@field label? string  as the text of a label; "" shows nothing. Default ""
---@field width? number  width of the line, points. Default nil: an eighth of `size`
---@field hidden? "drawn"|"dashed"|"none"  how the part behind surfaces is drawn. Default "drawn"
---@field size? number  size of the letters, points, 1 .. 10000. Default nil: 1/36 of the picture's height, at least 10 pixels
---@field margin? number  distance from the line to the label, points. Default nil: half of `size`
---@field color? glint.color  colour of the line and the letters, without the tone curve. Default 1
---@field background? glint.color  colour of a rectangle behind the label. Default nil: none
---@field opacity? number  opacity of the background, 0 .. 1. Default 1
---@field name? string  for messages, at most 63 bytes. Default ""

---@class glint.line_fields: glint.curve_fields
---@field from glint.vec3  start point in the world
---@field to glint.vec3  end point in the world

--- An arrow between two points of the world, drawn over the picture, with its label beyond its tip.
---@class glint.arrow: glint.line_fields, glint.object

---@param fields glint.line_fields
---@return glint.arrow
function glint.arrow(fields) end

--- A line between two points of the world, drawn over the picture, with its label next to its middle.
---@class glint.line: glint.line_fields, glint.object

---@param fields glint.line_fields
---@return glint.line
function glint.line(fields) end

---@class glint.arc_fields: glint.curve_fields
---@field at glint.vec3  the corner of the angle in the world
---@field from glint.vec3  the first direction from `at`
---@field to glint.vec3  the second direction from `at`
---@field radius? number  world units. Default nil: a twelfth of the picture's height

--- The angle between two directions at a point, drawn over the picture as part of a circle.
---@class glint.arc: glint.arc_fields, glint.object

---@param fields glint.arc_fields
---@return glint.arc
function glint.arc(fields) end

---@class glint.polyline_fields: glint.curve_fields
---@field points glint.vec3[]  2 .. 128 points in the world, joined by straight segments

--- Straight segments between points of the world, drawn over the picture, with a label next to the middle point.
---@class glint.polyline: glint.polyline_fields, glint.object
---@param fields glint.polyline_fields
---@return glint.polyline
function glint.polyline(fields) end

---@class glint.lobe_fields: glint.curve_fields
---@field point glint.vec3  the point in the world at which light is reflected
---@field material glint.material  the material whose highlight is shown
---@field to_light glint.vec3  direction to the light
---@field normal? glint.vec3  normal at the point. Default nil: the normal of the scene's surface at the point, on the side of the camera
---@field scale? number  length of a highlight of 1, world units, > 0. Default nil: 1

--- The polar diagram of a highlight, in the plane of normal and light. Its length in a direction is the specular light
--- of material:evaluate, the mean of red, green and blue. Computed before each frame from the material as it is then.
---@class glint.lobe: glint.lobe_fields, glint.object
---@field strokes glint.vector[][]  the points computed for the last frame, a list for each stroke; read-only
---@param fields glint.lobe_fields
---@return glint.lobe
function glint.lobe(fields) end

---@class glint.path_fields: glint.curve_fields
---@field scene? glint.scene  the scene that the ray goes through. Default nil: the scene that is rendered
---@field origin glint.vec3  start of the ray in the world
---@field direction glint.vec3  direction of the ray, not zero
---@field depth? integer  number of surfaces at which the ray goes on, 0 .. 63. Default 4
---@field reach? number  length of a segment that hits nothing, world units, > 0. Default nil: the length of the first segment

--- The path of a ray, mirrored and refracted, with a dot at each hit. Rays with less than a hundredth of the light are
--- left out, and there are at most 64 segments. Computed before each frame from the scene as it is then.
---@class glint.path: glint.path_fields, glint.object
---@field strokes glint.vector[][]  the points computed for the last frame, a list for each stroke; read-only
---@param fields glint.path_fields
---@return glint.path
function glint.path(fields) end

---@class glint.frustum_fields: glint.curve_fields
---@field camera glint.camera  the camera whose view is shown
---@field distance? number  distance of the far side from the eye along the view, world units, > 0. Default nil: the distance of the point that the camera looks at, or 1
---@field aspect? number  width of the camera's picture divided by its height, > 0; a camera with `w` and `h` has its own. Default 16 / 9

--- The view of a camera: edges from its eye to the corners of its picture, and the sides of the picture. Computed before
--- each frame from the camera as it is then.
---@class glint.frustum: glint.frustum_fields, glint.object
---@field strokes glint.vector[][]  the points computed for the last frame, a list for each stroke; read-only
---@param fields glint.frustum_fields
---@return glint.frustum
function glint.frustum(fields) end

---@alias glint.overlay glint.label|glint.colorbar|glint.axes|glint.arrow|glint.line|glint.arc|glint.polyline|glint.lobe|glint.path|glint.frustum

-- ---- Scene ----

--- If read from a scene, its fields are read-only: assign a whole table.
---@class glint.indirect
---@field samples? integer  light paths traced from each visible point, 1 .. 65536. Default 16
---@field bounces? integer  maximum number of matt surfaces at which a path continues, 0 .. 2^31; `ambient` approximates the rest. Default 2

--- Ambient light times the unoccluded share of the sky, weighted by the cosine. If read from a scene, or made by
--- glint.ambient_occlusion, its fields are read-only: assign a whole table.
---@class glint.ambient_occlusion
---@field samples? integer  rays from each visible point, 1 .. 65536. Default 16
---@field distance? number  world units, > 0: surfaces farther away do not occlude. Default math.huge

--- Checks the fields of a scene's `ambient_occlusion` and returns them. A scene also accepts the result as an object.
---@param fields glint.ambient_occlusion
---@return glint.ambient_occlusion
function glint.ambient_occlusion(fields) end

---@class glint.scene_fields
---@fields scene

---@class glint.scene_table: glint.scene_fields
---@field [integer] glint.shape|glint.light|glint.overlay|glint.ambient_occlusion  the objects, numbered in this order, without gaps

---@class glint.scene: glint.scene_fields, glint.object
---@field [integer] glint.shape|glint.light|glint.overlay  the objects in the order of objects(), from 1
local scene = {}

--- Adds a shape, light or overlay, numbered after the others of its kind. Raises if it is in the scene already.
---@generic T: glint.shape|glint.light|glint.overlay|glint.ambient_occlusion
---@param object T
---@return T object  the same
function scene:add(object) end

--- Removes a shape, light or overlay. Raises if it is not in the scene.
---@param object glint.shape|glint.light|glint.overlay|glint.ambient_occlusion
function scene:remove(object) end

---@class glint.hit
---@field t number  the point is origin + t * direction; > 0
---@field point glint.vector  world units
---@field normal glint.vector  unit, geometric, outward (a plane's own)
---@field object glint.shape
---@field element? integer  index of the sphere in a glint.spheres or of the triangle in a mesh, from 1; nil for other shapes

--- Returns the nearest hit of one ray, computed in double precision by the kernels of a frame.
---@param origin glint.vec3  world units
---@param direction glint.vec3  not zero, need not be unit
---@return glint.hit? hit  nil when nothing is hit
function scene:cast(origin, direction) end

--- Returns a new list: the shapes, the lights, then the overlays, each in the order of definition. `#scene` is their
--- number, `scene[i]` one of them.
---@return (glint.shape|glint.light|glint.overlay)[]
function scene:objects() end

--- Renders one frame. In a plain loop the calls are numbered from 1: a call that --frames or --shard excludes returns
--- nil and "skipped". Without `output` nothing is written.
---@param options? glint.render
---@return glint.image? image
---@return "skipped"? reason
function scene:render(options) end

---@param fields glint.scene_table
---@return glint.scene
function glint.scene(fields) end

-- ---- Frames ----

---@alias glint.pass
---| "beauty"  # (((((background + ambient) + diffuse) + specular) + indirect) + mirror) + transmission, exactly
---| "background"
---| "ambient"
---| "diffuse"
---| "specular"
---| "indirect"
---| "mirror"
---| "transmission"
---| "depth"  # distance from the eye, one number; inf where nothing is hit
---| "normal"  # shading normal, on the viewer's side; 0 where nothing is hit
---| "object_id"  # 1 .. in order of definition, one number; 0 where nothing is hit
---| "alpha"  # the share of the samples that hit something, minus the share of the background that is visible through glass and translucent surfaces; one number, 0 .. 1
---| "refined"  # 1 where `adaptive` took all samples, else 0; one number
---| "albedo"  # diffuse reflectance, including patterns, of the first surface that is not a smooth mirror or smooth glass; rough surfaces add what they reflect and transmit; 0 where nothing is hit
---| string  # "d:NAME": how fast beauty changes with the variable or parameter NAME; three numbers. "light:NAME": the light of the lamps
--- of that group or name; "light:ambient": the light that comes from no lamp; "light:*": all of these
---| "outline"  # 1 on outlines and edges of objects, else 0; one number, at the pixel's centre

--- Options of a frame and its file. The command line takes precedence.
---@class glint.render
---@field width? integer  pixels, 1 .. 65535. Default 1280
---@field height? integer  pixels, 1 .. 65535. Default 720
---@field samples? integer  samples per pixel, 1 .. 65536. Default 1
---@field adaptive? number  0 .. 3: takes all samples only in pixels at an edge, and in pixels that differ from a neighbour by more than this number: the sum of the differences in red, green and blue, with white at 1. Other pixels get one sample. Default 0: off
---@field seed? integer  0 .. 2^53: selects one of many equally good sample patterns. Default 0
---@field max_depth? integer  longest chain of mirrors and refractions, 0 .. 2^31; at most 31 if mirror + transmission of a material exceeds 1. Default 5
---@field clamp? number  the most light that one random path (indirect light, rough surfaces) may bring from one of its later surfaces, in units of the picture; removes bright dots together with a part of the light. Default 0: no limit
---@field rays? integer  0 .. 65536: the most rays of each kind that a sample sends: to each area light, for indirect light or ambient occlusion, and from a rough surface. For quick, noisy pictures. Default 0: as many as the lights and the scene say
---@field precision? "double"|"float"  the number format in which hits and shadows are decided. Default "double"
---@field visibility? "auto"|"cast"|"scan"  how visible surfaces are found: by casting a ray through each sample, or by projecting triangles. The pictures are identical. Default "auto"
---@field bits? 8|16  bits per channel of a .png. Default 8
---@field transfer? "srgb"|"linear"|"none"  how light is converted to pixel values; "none": linear, but not marked as linear, so that viewers treat the values as sRGB. Default "srgb"
---@field rounding? "nearest"|"truncate"  Default "nearest"
---@field tone? "clamp"|"reinhard"|"filmic"  tone curve for bright light: cut at 1; x/(1+x); Hable's curve, white at 5.6. Default "clamp"
---@field exposure? number  stops, -32 .. 32: light is multiplied by 2^exposure before the tone curve. Default 0
---@field alpha? boolean  transparent background, also behind glass and translucent surfaces: a .png is RGBA, and passes store light times coverage. Default false
---@field outline? "none"|"black"|"white"  colour of lines drawn into the .png where the pass "outline" is 1. Default "none"
---@field dither? boolean  ordered dithering of 8-bit pixel values instead of rounding, against bands in dark gradients. Default false
---@field encode? "fast"|"small"  compression of a .png; the pixels are identical. Default "fast"
---@field colormap? "none"|"viridis"|"magma"|"cividis"|"turbo"|"coolwarm"|string  colour map for the .png of depth and d:NAME. "viridis:1:9" maps 1 to the first colour and 9 to the last, linearly. Default "none": grey, over the range of the picture's values
---@field dpi? number  pixels per inch for printing a .png, .svg or .pdf, 0 .. 1e6. Default 0: not stored; then a pixel of a .svg or .pdf is a point
---@field output? string  file name, .png, .svg or .pdf (overlays as vectors), .pfm, .npy or .exr (all passes in one file); %04d or #### takes the frame number. Or a film: .mp4, .webm, .gif, .apng
---@field passes? glint.pass[]|string  passes written in addition to the beauty: a list, or "ambient,depth"; "all": every pass except d:NAME. Default none
---@field region? integer[]|string  { x, y, width, height } or "x,y,width,height": renders only this part of the frame, in pixels from the top left, bit-identical to the same part of the whole frame. Default: all
---@field orbit? boolean|string  whether the reader of a live figure may turn the view around the point at which the camera looks. Default false. "YAW,PITCH,ZOOM,RIGHT,UP" turns it, as `--orbit` does

---@class glint.save_options
---@field bits? 8|16  bits per channel of a .png. Default 8
---@field transfer? "srgb"|"linear"|"none"  Default "srgb"
---@field rounding? "nearest"|"truncate"  Default "nearest"
---@field tone? "clamp"|"reinhard"|"filmic"  Default "clamp"
---@field exposure? number  stops, -32 .. 32. Default 0
---@field dither? boolean  Default false
---@field encode? "fast"|"small"  Default "fast"
---@field colormap? "none"|"viridis"|"magma"|"cividis"|"turbo"|"coolwarm"|string  colour map for depth and d:NAME. "viridis:1:9" maps 1 to the first colour and 9 to the last, linearly. Default "none": grey, over the range of the picture's values
---@field dpi? number  pixels per inch of a .png, .svg or .pdf, 0 .. 1e6. Default 0: not stored
---@field pass? glint.pass  Default "beauty"

---@class glint.image: glint.object
---@field width integer  pixels; read-only
---@field height integer  pixels; read-only
---@field passes glint.pass[]  the passes that can be read; read-only
---@field exposure number  exposure of the pixel values in stops, from the script or --exposure; read-only
local image = {}

--- Returns one pixel, linear. (0, 0) is the top left.
---@param x integer  0 .. width - 1
---@param y integer  0 .. height - 1
---@param pass? glint.pass  Default "beauty"
---@return number r  red; the only result for "depth", "object_id", "alpha" and "outline"
---@return number g
---@return number b
function image:pixel(x, y, pass) end

--- Returns a pass as float32 numbers, little endian, row by row from the top: "<f" of string.unpack, "<f4" of NumPy.
--- Light has three numbers per pixel; depth, object_id and similar passes have one.
---@param pass? glint.pass  Default "beauty"
---@return string
function image:bytes(pass) end

--- Returns a pass as an array with a row for each pixel, from the top left, row by row of the picture.
---@param pass? glint.pass  Default "beauty"
---@return glint.array
function image:array(pass) end

--- Writes a .png, .svg, .pdf, .pfm, .npy or .exr, which appears whole or not at all. Missing folders are made. Wrong use raises; a
--- failure to write the file returns nil and a message.
---@param path string
---@param options? glint.save_options
---@return true? done
---@return string? message
function image:save(path, options) end

-- ---- Jobs ----

--- Parameters that `--set name=value` changes. Each is a default, or a table with the default and its limits.
--- They are read as `P.name`. The default determines the type.
---@class glint.param
---@field [1] number|boolean|string|glint.vec3  the default; a point { x, y, z } is read as a vector, and set by NAME=X,Y,Z
---@field min? number  smallest value allowed
---@field max? number  largest value allowed
---@field choices? (number|string)[]  the only values allowed
---@field whole? boolean  whether only whole numbers are allowed
---@field doc? string  one line for `--help`, and below the control of a live figure
---@field label? string  name of the control of a live figure, which may have formulas between $. Default: the parameter's name
---@field unit? string  unit of a number, shown after its value
---@field names? table<number|string, string>  texts shown for `choices`: { blinn_phong = "Blinn-Phong" }
---@field drag? boolean  whether the reader of a live figure may drag the point in the picture. Default false

---@param list table<string, glint.param|number|boolean|string>
---@return table<string, any>
function glint.params(list) end

--- A number with its derivatives by variables. Arithmetic and the functions of `math` compute further dual numbers.
--- Fields of materials, lights, spheres, planes, cameras and scenes accept them.
---@class glint.dual
---@operator add(any): any
---@operator sub(any): any
---@operator mul(any): any
---@operator div(any): any
---@operator mod(any): any
---@operator pow(any): any
---@operator unm: any

--- A variable with a value: the pass "d:<name>" is the derivative of the picture by it. At most 32 names in a script.
---@param name string  1 to 31 bytes without blanks and commas
---@param value number
---@return glint.dual
function glint.variable(name, value) end

--- Returns the plain number.
---@param x glint.dual|number
---@return number
function glint.value(x) end

---@class glint.animation_fields: glint.render
---@field scene glint.scene
---@field frames? integer  >= 1, numbered from 1. Default 1
---@field fps? number  frames per second, > 0. Default 24
---@field cyclic? boolean  true: t = (n-1)/frames, so that the last frame leads to the first; false: t = (n-1)/(frames-1). Default false
---@field frame? fun(t: number, n: integer)  sets the scene to frame n; must depend only on t and n. Without this function all frames show the scene unchanged

---@class glint.animation: glint.animation_fields
local animation = {}

--- Renders the frames. For plain Lua: the command renders the frames that a script returns.
---@param options? table
function animation:run(options) end

---@param fields glint.animation_fields
---@return glint.animation
function glint.animation(fields) end

--- A contact sheet of a sweep's frames, drawn when all of them are finished: a table of pictures, as a picture, or as a
--- page with a slider for each axis. The values of the first axis are heads above the columns, the values of the second are beside
--- the rows; all other axes make blocks.
---@class glint.sheet
---@field label? boolean|string|fun(values: table<string, any>, n: integer, pass: string): string  true: heads with the values of the axes; false: neither heads nor labels; a text under each picture, such as "n = {shininess}", which may also contain {file} and {frame}; or a function that returns this text. Default true
---@field names? table<string, string>  names of axes and of values on the sheet, such as { shininess = "n", blinn_phong = "Blinn-Phong" }, at most 100 bytes each; `glint sheet` finds them in the pictures. Default: the axes' own
---@field format? string|table<string, string>  how numbers are written, such as "%.2f": text with one %f, %e or %g; a table has a format for each axis, such as { shininess = "%.0f" }. Default: up to four digits
---@field passes? boolean  the passes that the sweep renders are an axis, the first one, after "beauty". Default false
---@field columns? integer  pictures per row of a .png, 1 .. 65535. Default: the number of values on the first axis
---@field difference? integer  number of a frame of the sweep, from 1: a second row shows the difference of each picture from this frame. Default none
---@field gain? number  factor of the differences, 0.001 .. 1e6; with `difference`. Default 8
---@field title? string  text above the sheet. Default none
---@field size? number  size of the sheet's text, points, 1 .. 10000. Default: 13 pixels, or 26 for pictures at least 900 pixels wide
---@field dpi? number  pixels per inch of the .png; a point is dpi / 72 pixels, or 1 pixel without dpi. Default: the dpi of the pictures
---@field transparent? boolean  the background of the sheet is transparent. Default false
---@field colorbar? glint.colorbar  a colour bar for all pictures of a .png: to their right or, if horizontal, below them; in the sheet's text size and colour. Default none
---@field output? string  file name, .png, .svg, .pdf or .html. Default: sheet.png or NAME_sheet.png next to the frames, with the number of the first frame unless that is 1

---@class glint.sweep_fields: glint.render
---@field scene glint.scene
---@field over table[]  the axes, each {object, "field", {values}}; every combination is a frame; the first axis goes across
---@field size? integer[]  {width, height}, instead of the two fields
---@field sheet? glint.sheet  a contact sheet of the frames

---@class glint.sweep: glint.sweep_fields
local sweep = {}

--- Renders the frames. For plain Lua: the command renders the frames that a script returns.
---@param options? table
function sweep:run(options) end

---@param fields glint.sweep_fields
---@return glint.sweep
function glint.sweep(fields) end

-- ---- Patterns and shaders ----

-- A function that describes a material at a point, or the light that it reflects from one lamp. It is called once per
-- frame with symbols instead of numbers. The operations on symbols are recorded as a program, which runs at the speed
-- of a kernel and returns the same bits as plain Lua. Loops and calls are unrolled. Variables outside may change
-- between frames. Symbols cannot be compared: `a < b`, `==`, `#`, `..` and math.sin of a symbol raise, with a hint. `if`, `and`
-- and `or` cannot raise, so plain Lua also runs each new function at 64 points and must return the program's results. A
-- branch that no point takes goes undetected.

--- Three numbers or symbols: p, s.n, and results computed from them. `a + b`, `a - b`, `a * b`, `a / b`, `a % b`,
--- `a // b`, `a ^ b` and `-a` work by component; one side may be a number or a symbol. Operations on vectors also
--- accept a table with x, y and z, or a list of three.
---@class glint.triple
---@field x number  also v[1]
---@field y number  also v[2]
---@field z number  also v[3]
---@field r number  the same as x
---@field g number  the same as y
---@field b number  the same as z
---@field u number  the same as x, of s.uv
---@field v number  the same as y, of s.uv
---@operator add(glint.values): glint.triple
---@operator sub(glint.values): glint.triple
---@operator mul(glint.values): glint.triple
---@operator div(glint.values): glint.triple
---@operator mod(glint.values): glint.triple
---@operator idiv(glint.values): glint.triple
---@operator pow(glint.values): glint.triple
---@operator unm: glint.triple
local triple = {}

---@param b glint.values
---@return number
function triple:dot(b) end

---@param b glint.values
---@return glint.triple
function triple:cross(b) end

---@return number
function triple:length() end

--- Returns the vector divided by its length.
---@return glint.triple
function triple:unit() end

--- Reflects an incident direction in a mirror with the unit normal n: d - 2 (n.d) n.
---@param n glint.values
---@return glint.triple
function triple:reflect(n) end

---@return number x
---@return number y
---@return number z
function triple:unpack() end

--- A number, symbol, vector, table {x, y, z} of numbers and symbols, or (for named operations) the name of a colour.
---@alias glint.values glint.triple|glint.vector|number[]|number|string

--- The inputs of a function at a point.
---@class glint.surroundings
---@field p glint.triple  the point in its shape's own space, before the shape's transform and those of its groups. On faces of boxes and on planes with an axis as normal, the component along the normal is exactly the coordinate of the face
---@field world glint.triple  the point in world space
---@field n glint.triple  the geometric normal, unit, on the viewer's side
---@field v glint.triple  towards the eye, unit
---@field uv glint.triple  coordinates on the surface, u and v: world units along a plane, 0 .. 1 around and along spheres, cylinders and cones, around a torus and around its tube, across each face of a box, `vt` of a mesh
---@field footprint number  width of the pixel at the point, world units; 0 where it is not known
---@field uv_footprint number  width of the pixel in units of u and v
---@field l glint.triple  in shaders: direction to the light, unit; n.l > 0
---@field light glint.triple  in shaders: colour x intensity x attenuation of the light; the engine handles shadows
---@field distance number  in shaders: distance to the light, world units
---@field kd glint.triple  in shaders: the material's diffuse
---@field ks glint.triple  in shaders: the material's specular
---@field shininess number  in shaders: the material's shininess

--- A colour or a number at each point. The material fields diffuse, ambient, specular, mirror, transmission, shininess,
--- roughness, bump and opacity accept patterns, and a scene's background. `#pattern` is its program's length,
--- `tostring(pattern)` the program; `pattern(p, s)` calls the function. NaN and negative values count as 0.
---@class glint.pattern
local pattern = {}

--- Returns the colour at a point, computed by the frame's kernel; a single number is grey. `at` names fields of `s`.
---@param at table  {p = {x, y, z}, uv = {u, v}, n = ..., ...}
---@return glint.vector
function pattern:evaluate(at) end

---@param f fun(p: glint.triple, s: glint.surroundings): glint.values
---@return glint.pattern
function glint.pattern(f) end

--- The light that a point reflects from one lamp: the diffuse part and, optionally, the specular part. It is a
--- material's `model`, and is called where n.l > 0. The engine adds ambient light.
---@class glint.shader
local shader = {}

--- Returns both parts at a point, computed by the frame's kernel.
---@param at table  {n = {x, y, z}, l = ..., v = ..., light = ..., kd = ..., ...}
---@return glint.reflection
function shader:evaluate(at) end

---@param f fun(s: glint.surroundings): glint.values, glint.values?
---@return glint.shader
function glint.shader(f) end

---@class glint.texture_fields
---@field file string  a .png, .jpg, .hdr, .exr or .pfm file. The last three hold linear light, also above 1. JPEG and OpenEXR need a build with their libraries
---@field wrap? "repeat"|"clamp"|"around"  beyond 0 .. 1: repeats the picture, extends its border, or repeats it horizontally and extends its border vertically. Default "repeat"
---@field filter? "bilinear"|"nearest"  "bilinear" interpolates four texels of a copy of the picture that is reduced to fit the footprint; "nearest" takes the nearest texel. Default "bilinear"
---@field transfer? "srgb"|"linear"  how the file's values are read. Default "srgb", except for a file that is marked as linear

--- A picture. Inside a pattern call it: photo(u, v, footprint) or photo(s.uv, s.uv_footprint) returns red, green and
--- blue as a vector, and alpha as its field `a`. (0, 0) is the lower left corner, (1, 1) the upper right one. A second
--- footprint is the width along v. Without a footprint the picture is not filtered. As a material's field the texture is placed by the shape's uv, as a scene's
--- background by the direction.
---@class glint.texture: glint.texture_fields
---@field width integer  pixels
---@field height integer  pixels
local texture = {}

--- Returns the colour at {uv = {u, v}}, computed by the frame's kernel.
---@param at table
---@return glint.vector
function texture:evaluate(at) end

---@param fields glint.texture_fields
---@return glint.texture
function glint.texture(fields) end

--- A function from numbers to colours: viridis, magma and cividis run evenly from dark to light, turbo
--- through the rainbow, coolwarm from blue over grey to red, for numbers on both sides of a middle. Numbers
--- beyond the range get the colours of its ends. Inside a pattern it also accepts symbols, with the same
--- bits. A map of your own is a list of evenly spaced colours, or a function from 0 .. 1 to a colour; it has
--- 256 steps.
---@param map "viridis"|"magma"|"cividis"|"turbo"|"coolwarm"|glint.color[]|fun(share: number): glint.color
---@param low? number  the value of the first colour. Default 0
---@param high? number  the value of the last colour, different from low. Default 1
---@param scale? "linear"|"log"  "log": equal ratios are equal steps of colour; low and high must be above 0. Default "linear"
---@param missing? glint.color  colour of a missing value, NaN. Default "#808080"
---@return fun(x: number|glint.array): glint.vector|glint.array  an array of numbers gives an array of colours
function glint.colormap(map, low, high, scale, missing) end

-- ---- Operations ----

-- For numbers, with the same bits on every machine; inside a pattern also for symbols, with the same bits again.
-- Operations on numbers also accept vectors and work by component; a number is combined with each component.
-- Comparisons such as less return 1 or 0. As a condition every number except 0 is true.

---@param a glint.values
---@param b glint.values
---@return number
function glint.dot(a, b) end

---@param a glint.values
---@param b glint.values
---@return glint.triple
function glint.cross(a, b) end

---@param a glint.values
---@return number
function glint.length(a) end

---@param a glint.values
---@return glint.triple
function glint.unit(a) end

--- d - 2 (n.d) n.
---@param d glint.values
---@param n glint.values
---@return glint.triple
function glint.reflect(d, n) end

--- Makes a vector from three numbers or symbols, or from one value for all of them.
---@param x glint.values
---@param y? number
---@param z? number
---@return glint.triple
function glint.vector(x, y, z) end

--- a + b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.add(a, b) end

--- a - b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.sub(a, b) end

--- a b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.mul(a, b) end

--- a / b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.div(a, b) end

--- -a.
---@param a glint.values
---@return any
function glint.neg(a) end

---@param a glint.values
---@return any
function glint.abs(a) end

---@param a glint.values
---@return any
function glint.sqrt(a) end

--- a < b ? a : b; of more values the smallest.
---@param a glint.values
---@param b glint.values
---@param ... glint.values
---@return any
function glint.min(a, b, ...) end

--- a > b ? a : b; of more values the largest.
---@param a glint.values
---@param b glint.values
---@param ... glint.values
---@return any
function glint.max(a, b, ...) end

---@param a glint.values
---@return any
function glint.floor(a) end

---@param a glint.values
---@return any
function glint.ceil(a) end

--- Rounds to the nearest whole number, halves away from 0.
---@param a glint.values
---@return any
function glint.round(a) end

--- a - floor(a).
---@param a glint.values
---@return any
function glint.fract(a) end

--- a % b as in Lua on floats.
---@param a glint.values
---@param b glint.values
---@return any
function glint.mod(a, b) end

--- 1, 0 or -1.
---@param a glint.values
---@return any
function glint.sign(a) end

--- a b + c.
---@param a glint.values
---@param b glint.values
---@param c glint.values
---@return any
function glint.muladd(a, b, c) end

--- a - b c.
---@param a glint.values
---@param b glint.values
---@param c glint.values
---@return any
function glint.submul(a, b, c) end

--- a b - c.
---@param a glint.values
---@param b glint.values
---@param c glint.values
---@return any
function glint.mulsub(a, b, c) end

--- a + t (b - a).
---@param a glint.values
---@param b glint.values
---@param t glint.values
---@return any
function glint.mix(a, b, t) end

--- a < b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.less(a, b) end

--- a <= b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.lesseq(a, b) end

--- a == b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.equal(a, b) end

--- 1 if both are true. `and` is a keyword of Lua: write glint["and"](a, b).
---@param a glint.values
---@param b glint.values
---@return any
glint["and"] = function(a, b) end

--- 1 if either is true. `or` is a keyword of Lua: write glint["or"](a, b).
---@param a glint.values
---@param b glint.values
---@return any
glint["or"] = function(a, b) end

--- 1 if a is 0, else 0.
---@param a glint.values
---@return any
glint["not"] = function(a) end

--- a if c is true, else b. Both are computed.
---@param c glint.values
---@param a glint.values
---@param b glint.values
---@return any
function glint.select(c, a, b) end

--- x < edge ? 0 : 1.
---@param edge glint.values
---@param x glint.values
---@return any
function glint.step(edge, x) end

--- From 0 at a to 1 at b, t t (3 - 2 t).
---@param a glint.values
---@param b glint.values
---@param x glint.values
---@return any
function glint.smoothstep(a, b, x) end

--- Clamps the value to the range from a to b.
---@param x glint.values
---@param a glint.values
---@param b glint.values
---@return any
function glint.clamp(x, a, b) end

--- The argument is in radians.
---@param a glint.values
---@return any
function glint.sin(a) end

--- The argument is in radians.
---@param a glint.values
---@return any
function glint.cos(a) end

--- 2 ^ a.
---@param a glint.values
---@return any
function glint.exp2(a) end

---@param a glint.values
---@return any
function glint.log2(a) end

--- a ^ b.
---@param a glint.values
---@param b glint.values
---@return any
function glint.pow(a, b) end

---@alias glint.easing "linear"|"smooth"|"smoother"|"in"|"out"

--- Returns the share of a motion that is done after the share t of its time: 0 before the start, 1 after the end. smooth (the
--- default): 3 t^2 - 2 t^3; smoother: 6 t^5 - 15 t^4 + 10 t^3; in: t^2; out: 2 t - t^2.
---@param t number
---@param kind glint.easing?
---@return number  0 .. 1
function glint.ease(t, kind) end

---@class glint.keys
---@field [integer] {[1]: number, [2]: number|glint.vector|number[]}  time and value, in ascending order of time; at least two keys
---@field ease (glint.easing|"spline")?  how the value moves from each key to the next; spline: smoothly through the keys (Catmull-Rom)
---@field cyclic boolean?  the keys repeat after the last one

--- Returns a function of time through keys. It returns a number, a vector for values of three numbers, otherwise a
--- list. Before the first key it returns the first value, after the last key the last value.
---@param keys glint.keys
---@return fun(t: number): any
function glint.keys(keys) end

--- Radians, -pi .. pi.
---@param y glint.values
---@param x glint.values
---@return any
function glint.atan2(y, x) end

--- Radians, 0 .. pi.
---@param a glint.values
---@return any
function glint.acos(a) end

--- cosine ^ shininess as in the built-in models, 0 where the cosine is not above 0.
---@param cosine glint.values
---@param shininess glint.values
---@return any
function glint.highlight(cosine, shininess) end

--- Gradient noise: smooth, -1 .. 1, 0 at whole numbers. Takes a vector, or x, y and z.
---@param p glint.values
---@return number
function glint.noise(p, y, z) end

--- Returns three independent noise values.
---@param p glint.values
---@return glint.triple
function glint.noise3(p, y, z) end

--- Returns the distances to the nearest and second nearest of random points, one in each unit cube.
---@param p glint.values
---@return number first
---@return number second
function glint.cell(p, y, z) end

--- Returns a pseudo-random number in [0, 1), independent of the numbers at other points.
---@param p glint.values
---@return number
function glint.hash(p, y, z) end

--- (floor(x) + floor(y) + floor(z)) % 2, for numbers of any size.
---@param p glint.values
---@return number
function glint.parity(p, y, z) end

--- The parity of a point: 0 or 1. With a footprint (a number or vector) the mean over a box of that width around p. A
--- component that is a whole number is not averaged: the surface lies in that plane.
---@param p glint.values
---@param footprint? glint.values
---@return number
function glint.checker(p, footprint) end

--- The parity of floor(x); with a footprint, its mean over that width.
---@param x number
---@param footprint? number
---@return number
function glint.stripe(x, footprint) end

--- Bricks of one by one unit in x and y, with every other row shifted by half a brick: 1 on a brick, 0 on the mortar
--- along its left and lower sides. With a footprint, the mean over that width.
---@param p glint.values
---@param mortar? number  width of the mortar. Default 0.1
---@param footprint? number
---@return number
function glint.brick(p, mortar, footprint) end

-- ---- Only for numbers ----

---@param radians glint.values
---@return any
function glint.tan(radians) end

---@param x glint.values
---@return any
function glint.exp(x) end

--- The natural logarithm.
---@param x glint.values
---@return any
function glint.log(x) end

-- ---- Existing pictures ----

--- A finished picture or a photo. Its numbers are linear light, whatever the file stores.
---@class glint.picture
---@field width integer  pixels; read-only
---@field height integer  pixels; read-only
local picture = {}

--- Returns red, green and blue; (0, 0) is the top left.
---@param x integer
---@param y integer
---@return number, number, number
function picture:pixel(x, y) end

--- Returns all pixels as float32 numbers, little endian, three per pixel, row by row from the top.
---@return string
function picture:bytes() end

--- Returns all pixels as an array with a row for each, from the top left, row by row.
---@return glint.array
function picture:array() end

--- Reads a .png or .pfm.
---@param path string
---@return glint.picture
function glint.read_image(path) end

return glint
