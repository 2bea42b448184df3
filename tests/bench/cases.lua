-- What `make bench` measures, and the rows of its table.
--
-- A measurement runs a side's program once a round, when a row of a selected part names it: { id, side, arguments,
-- runs = at most }. The program prints lines "name unit value"; a row names one as "id:name".
-- A row: { part, title, ours, theirs, bar = , more = true when the bar is a least, note = }. `ours` and `theirs` are such
-- names; the ratio is ours / theirs, or theirs / ours where `more`. `ours` nil: `note` tells why glint has no number.
local measurements = {
  -- one frame of the workshop, 1920x1080
  { "g.frame", "glint", "frame" },
  { "g.frame.2", "glint", "frame threads=2" },
  { "g.float", "glint", "frame float=1" },
  { "g.bare", "glint", "frame shadows=0" },
  { "g.4", "glint", "frame samples=4" },
  { "g.area", "glint", "frame area=1" },
  { "h.frame", "hand", "frame" },
  { "h.frame.2", "hand", "frame threads=2" },
  { "h.bare", "hand", "frame shadows=0" },
  { "h.4", "hand", "frame samples=4" },
  { "h.area", "hand", "frame area=1" },
  { "e.frame", "embree", "frame" },
  { "e.bare", "embree", "frame shadows=0" },
  { "e.4", "embree", "frame samples=4" },
  { "e.area", "embree", "frame area=1" },

  -- pixels that are more than two codes from glint's
  { "u.hand", "unlike hand", "scene=workshop", runs = 1 },
  { "u.embree", "unlike embree", "scene=workshop", runs = 1 },
  { "u.float", "unlike glint", "float=1", runs = 1 },
  { "u.1k", "unlike embree", "scene=1k", runs = 1 },

  -- render only, in one process, frame after frame of a job
  { "g.moved", "glint", "reuse change=light" },
  { "g.ball", "glint", "reuse change=sphere" },
  { "g.shiny", "glint", "reuse change=shininess" },

  -- 60 frames to 60 PNG files
  { "g.light.1", "glint", "job change=light threads=1 out=$OUT" },
  { "g.light.2", "glint", "job change=light threads=2 out=$OUT" },
  { "g.light.fresh", "glint", "job change=light threads=2 reuse=0 out=$OUT" },
  { "g.light.float", "glint", "job change=light threads=2 float=1 out=$OUT" },
  { "g.shininess.1", "glint", "job change=shininess threads=1 out=$OUT" },
  { "g.shininess.2", "glint", "job change=shininess threads=2 out=$OUT" },
  { "h.light.1", "hand", "job change=light threads=1 out=$OUT" },
  { "h.light.2", "hand", "job change=light threads=2 out=$OUT" },
  { "h.shininess.2", "hand", "job change=shininess threads=2 out=$OUT" },

  -- many spheres
  { "g.1k", "glint", "frame scene=1k" },
  { "g.1M", "glint", "frame scene=1M" },
  { "g.1M.2", "glint", "frame scene=1M threads=2" },
  { "g.build", "glint", "build scene=1M threads=1" },
  { "g.build.2", "glint", "build scene=1M threads=2" },
  { "g.mesh", "glint", "frame scene=mesh" },
  { "g.mesh.build", "glint", "build scene=mesh threads=1" },
  { "g.box", "glint", "frame scene=box shadows=0" },
  { "e.1k", "embree", "frame scene=1k" },
  { "e.1M", "embree", "frame scene=1M" },
  { "e.1M.2", "embree", "frame scene=1M threads=2" },
  { "e.mesh", "embree", "frame scene=mesh" },

  { "g.encode", "glint", "encode out=$OUT" },
  { "h.encode", "hand", "encode" },

  { "g.program", "glint", "program" },
  { "h.program", "hand", "program" },

  { "g.ref", "glint", "stages isa=ref", runs = 3 },
  { "g.sse2", "glint", "stages isa=sse2" },
  { "g.avx2", "glint", "stages isa=avx2" },
  { "g.avx512", "glint", "stages isa=avx512" },

  -- the slow ones; a job's time is that of its first 6 frames, times 10
  { "p.frame", "povray", "frame", runs = 3 },
  { "p.bare", "povray", "frame shadows=0", runs = 3 },
  { "p.4", "povray", "frame samples=4", runs = 3 },
  { "p.area", "povray", "frame area=1", runs = 3 },
  { "p.1k", "povray", "frame scene=1k", runs = 3 },
  { "p.box", "povray", "frame scene=box shadows=0", runs = 1 },
  { "p.1M", "povray", "frame scene=1M", runs = 1 },
  { "p.light", "povray", "job change=light threads=2", runs = 1 },
  { "p.shininess", "povray", "job change=shininess threads=2", runs = 1 },
  { "t.frame", "tachyon", "frame", runs = 3 },
  { "t.bare", "tachyon", "frame shadows=0", runs = 3 },
  { "t.4", "tachyon", "frame samples=4", runs = 3 },
  { "t.1k", "tachyon", "frame scene=1k", runs = 3 },
  { "t.1M", "tachyon", "frame scene=1M", runs = 1 },
}


local rows = {
  { "One frame of the workshop, render only, one thread" },
  { "frame", "hard shadow", "g.frame:render", "h.frame:render", bar = 0.75 },
  { "frame", "hard shadow, two threads", "g.frame.2:render", "h.frame.2:render" },
  { "frame", "hard shadow", "g.frame:render", "e.frame:render" },
  { "peers", "hard shadow", "g.frame:render", "p.frame:render" },
  { "peers", "hard shadow", "g.frame:render", "t.frame:render" },
  { "frame", "no shadow", "g.bare:render", "h.bare:render" },
  { "frame", "no shadow", "g.bare:render", "e.bare:render" },
  { "peers", "no shadow", "g.bare:render", "p.bare:render" },
  { "peers", "no shadow", "g.bare:render", "t.bare:render" },
  { "frame", "4 samples a pixel", "g.4:render", "h.4:render" },
  { "frame", "4 samples a pixel", "g.4:render", "e.4:render" },
  { "peers", "4 samples a pixel", "g.4:render", "p.4:render" },
  { "peers", "4 samples a pixel", "g.4:render", "t.4:render" },
  { "frame", "16-sample area light", "g.area:render", "h.area:render", bar = 0.8 },
  { "frame", "16-sample area light", "g.area:render", "e.area:render" },
  { "peers", "16-sample area light", "g.area:render", "p.area:render" },
  { "frame", "with 8-bit sRGB codes", "g.frame:codes", "h.frame:codes" },
  { "frame", "pixels more than 2 codes off", nil, "u.hand:differ", note = "of 2,073,600" },
  { "frame", "pixels more than 2 codes off", nil, "u.embree:differ", note = "of 2,073,600" },
  { "frame", "pixels more than 2 codes off", nil, "u.float:differ", note = "of 2,073,600; glint --precision float" },
  { "frame", "shadow rays of a scene without shadows", "g.bare:shadow_rays", nil, bar = 0 },

  { "glint against itself" },
  { "frame", "two threads / one", "g.frame.2:render", "g.frame:render", bar = 0.55 },
  { "frame", "double / float, full frame", "g.frame:render", "g.float:render", bar = 1.30 },
  { "jobs", "double / float, 60-frame light job", "g.light.2:job", "g.light.float:job", bar = 1.10 },
  { "reuse", "moved light / full frame", "g.moved:kept", "g.moved:fresh", bar = 0.65 },
  { "reuse", "moved sphere / full frame", "g.ball:kept", "g.ball:fresh" },
  { "reuse", "changed shininess / full frame", "g.shiny:kept", "g.shiny:fresh", bar = 0.15 },
  { "jobs", "60-frame light job, two threads / one", "g.light.2:job", "g.light.1:job", bar = 0.55 },
  { "jobs", "60-frame shininess job, two threads / one", "g.shininess.2:job", "g.shininess.1:job", bar = 0.55 },
  { "jobs", "60-frame light job, reuse / none", "g.light.2:job", "g.light.fresh:job" },
  { "many", "1,000,000 spheres, two threads / one", "g.1M.2:render", "g.1M:render", bar = 0.55 },

  { "60 frames to 60 PNG files, two threads" },
  { "jobs", "moving light", "g.light.2:job", "h.light.2:job", bar = 3, more = true },
  { "peers", "moving light", "g.light.2:job", "p.light:job", bar = 100, more = true },
  { "jobs", "changing shininess", "g.shininess.2:job", "h.shininess.2:job", bar = 6, more = true },
  { "peers", "changing shininess", "g.shininess.2:job", "p.shininess:job", bar = 300, more = true },
  { "jobs", "moving light, one thread", "g.light.1:job", "h.light.1:job" },

  { "Many spheres and triangles, hard shadow, one thread unless told" },
  { "many", "1,000 spheres, render", "g.1k:render", "e.1k:render", bar = 0.6 },
  { "peers", "1,000 spheres, render", "g.1k:render", "p.1k:render" },
  { "peers", "1,000 spheres, render", "g.1k:render", "t.1k:render" },
  { "peers", "100,000 spheres, orthographic, no shadow", "g.box:render", "p.box:render", bar = 30, more = true },
  { "many", "1,000 spheres, pixels more than 2 codes off", nil, "u.1k:differ", note = "of 2,073,600" },
  { "many", "1,000,000 spheres, render", "g.1M:render", "e.1M:render", bar = 0.5 },
  { "many", "1,000,000 spheres, render, two threads", "g.1M.2:render", "e.1M.2:render", bar = 0.5 },
  { "peers", "1,000,000 spheres, render", "g.1M:render", "p.1M:render" },
  { "slow", "1,000,000 spheres, render", "g.1M:render", "t.1M:render" },
  { "many", "1,000,000 spheres, index build", "g.build:build", "e.1M:build", bar = 0.6 },
  { "many", "1,000,000 spheres, index build, two threads", "g.build.2:build", "e.1M.2:build", bar = 0.6 },
  { "many", "1,000,000 spheres, scene to first ray", "g.build:ready", nil },
  { "many", "1,000,000 spheres, rays a second", "g.1M:rays", nil },
  { "many", "500,000 triangles, render", "g.mesh:render", "e.mesh:render", bar = 1 },
  { "many", "500,000 triangles, index build", "g.mesh.build:build", "e.mesh:build" },
  { "many", "500,000 triangles, scene to first ray", "g.mesh.build:ready", nil },

  { "A point of a pattern or a shader, by the kernel alone" },
  { "programs", "Phong as a program", "g.program:phong", "h.program:phong", bar = 2 },
  { "programs", "checker", "g.program:checker", nil },
  { "programs", "three octaves of noise", "g.program:octaves", nil },
  { "programs", "marble", "g.program:marble", nil },
  { "programs", "cells", "g.program:cells", nil },

  { "One frame as PNG" },
  { "encode", "encode fast / zlib level 1", "g.encode:fast", "h.encode:zlib" },
  { "encode", "encode fast / libpng defaults", "g.encode:fast", "h.encode:libpng" },
  { "encode", "encode small / libpng defaults", "g.encode:small", "h.encode:libpng" },
  { "encode", "size fast / zlib level 1", "g.encode:fast_size", "h.encode:zlib_size" },
  { "encode", "size small / libpng defaults", "g.encode:small_size", "h.encode:libpng_size" },
}

-- Stages by instruction set: one row for each that the engine names, found as they come.
local stage_sides = { "g.ref", "g.sse2", "g.avx2", "g.avx512" }

return { measurements = measurements, rows = rows, stage_sides = stage_sides }
