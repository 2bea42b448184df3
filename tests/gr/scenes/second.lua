-- The second generation: meshes from .obj files, one of which several nodes share, and a file that dofile runs.
dofile('models/more.lua')

local gold = gr.material({0.9, 0.8, 0.4}, {0.8, 0.8, 0.4}, 25)
local blue = gr.material({0.5, 0.4, 0.8}, {0.8, 0.8, 0.8}, 80)

scene = gr.node('scene')
for i, at in ipairs { {-3, 0, 0}, {0, 0.5, 2}, {3, -0.5, -2} } do
  local tetra = gr.mesh('tetra' .. i, 'models/tetra.obj')
  tetra:set_material(i == 2 and gold or blue)
  tetra:rotate('y', 35 * i)
  tetra:scale(i == 3 and -1.5 or 1, 1 + 0.2 * i, 1)
  tetra:translate(table.unpack(at))
  scene:add_child(tetra)
end
star = gr.mesh('star', 'models/star.obj')
star:set_material(gold)
star:scale(2, 2, 2)
star:translate(0, 2.5, -1)
scene:add_child(star)
scene:add_child(ball('ball', blue, 1.5, 1, 3))

gr.render(scene, 'second.png', 80, 60, {0, 1, 12}, {0, -0.5, -10}, {0, 1, 0}, 40, {0.2, 0.2, 0.2},
  {gr.light({6, 9, 12}, {0.7, 0.7, 0.7}, {0.5, 0.02, 0.001})})
