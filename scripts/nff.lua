-- A scene from an NFF file, the format of the Standard Procedural Databases.
--     glint scripts/sphereflake.lua --set nff=balls.nff          makes one
--     glint scripts/nff.lua --set file=balls.nff                 nff.png
--     glint scripts/nff.lua --set file=gears.nff --set mirrors=false        without the mirrors and glass of `f` lines
local glint = require "glint"
local nff = require "glint.nff"

local P = glint.params {
  file = { "balls.nff", doc = "the file" },
  mirrors = { true, doc = "render mirrors and transparent surfaces" },
}
local picture = nff.load(P.file, { mirrors = P.mirrors })
picture.scene:render { width = picture.width, height = picture.height, samples = 4, output = "nff.png" }
