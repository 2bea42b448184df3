-- A scene from an NFF file, the format of the Standard Procedural Databases.
--     glint scripts/sphereflake.lua --set nff=balls.nff          makes one
--     glint scripts/nff.lua --set file=balls.nff                 nff.png
--     glint scripts/nff.lua --set file=balls.nff --set skip=p    passes over its polygons, which glint has not
local glint = require "glint"
local nff = require "glint.nff"

local P = glint.params {
  file = { "balls.nff", doc = "the file" },
  skip = { "none", choices = { "none", "p", "pp", "c" }, doc = "a kind of primitive to pass over" },
}
local picture = nff.load(P.file, { skip = { [P.skip] = true } })
picture.scene:render { width = picture.width, height = picture.height, samples = 4, output = "nff.png" }
