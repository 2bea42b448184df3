-- Writes the workshop's sky as a PNG file with linear pixel values:  lua5.4 sky.lua FILE
package.path = "scripts/lib/?.lua;" .. package.path
local png = require "glint.png"
local sky = dofile("tests/povray/workshop.lua").sky

-- Returns the linear light that the encoder turns into the pixel value 255 c.
local function decoded(c) return c <= 0.04045 and c / 12.92 or ((c + 0.055) / 1.055) ^ 2.4 end

local picture = png.new(sky.width, sky.height)
for y = 0, sky.height - 1 do
  for x = 0, sky.width - 1 do
    local c = sky.color((x + 0.5) / sky.width, (y + 0.5) / sky.height)
    picture:set(x, y, { decoded(c[1]), decoded(c[2]), decoded(c[3]) })
  end
end
picture:save(arg[1])
