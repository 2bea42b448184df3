-- A part that requires another part.
require 'parts/roof'
wall = gr.material({0.8, 0.75, 0.6}, {0.1, 0.1, 0.1}, 4)
house = gr.node('house')
local body = gr.cube('body')
body:set_material(wall)
body:scale(1.6, 1.1, 1.4)
body:translate(-0.5, -0.5, -0.5)
house:add_child(body)
house:add_child(roof(wall))
