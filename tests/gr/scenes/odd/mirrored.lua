-- Maps that turn space inside out, one inside the other.
local a = gr.material({0.7, 0.4, 0.5}, {0.6, 0.6, 0.6}, 15)
local root = gr.node('root')
local left = gr.node('left')
local m = gr.mesh('tetra', 'models/tetra.obj')
local c, k = gr.cone('cone'), gr.cylinder('can')
for i, shape in ipairs({m, c, k}) do
  shape:set_material(a)
  shape:rotate('x', 40) shape:scale(0.8, 0.6, 1.2) shape:translate(0, 2.1 * (i - 2), 0)
  left:add_child(shape)
end
left:rotate('z', 12)
left:translate(-1.6, 0, 0)
local right = gr.node('right')
right:add_child(left)
right:scale(-1, 1, 1)
local back = gr.node('back')
back:add_child(left)
back:scale(-0.6, -0.6, -0.6)
back:translate(0, 0, -2)
for _, n in ipairs({left, right, back}) do root:add_child(n) end
gr.render(root, 'mirrored', 40, 40, {0, 0, 8}, {0, 0, -1}, {0, 1, 0}, 45, {0.2, 0.2, 0.2},
  {gr.light({7, 5, 9}, {0.8, 0.8, 0.8}, {1, 0, 0}), gr.light({-7, -5, 9}, {0.2, 0.2, 0.4}, {1, 0, 0})})
