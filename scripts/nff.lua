-- A scene from an NFF file, the format of the Standard Procedural Databases.
--     glint scripts/sphereflake.lua --set nff=balls.nff          makes one
--     glint scripts/nff.lua --set file=balls.nff                 nff.png
--     glint scripts/nff.lua --set file=gears.nff --set skip_cones=true      passes over what glint does not read yet
local glint = require "glint"
local nff = require "glint.nff"

local P = glint.params {
  file = { "balls.nff", doc = "the file" },
  skip_cones = { false, doc = "pass over cones and cylinders" },
}
local picture = nff.load(P.file, { skip = { c = P.skip_cones } })
picture.scene:render { width = picture.width, height = picture.height, samples = 4, output = "nff.png" }
