-- A fractal of shared nodes: eight levels, each used twice in the next, so 256 copies of one ball and its children.
local bark = gr.material({0.5, 0.35, 0.2}, {0.1, 0.1, 0.1}, 10)
local leaf = gr.material({0.2, 0.6, 0.2}, {0.3, 0.3, 0.3}, 20)
local tip = gr.nh_sphere('leaf', {0, 0.35, 0}, 0.3)
tip:set_material(leaf)
local below = gr.node('tip')
below:add_child(tip)
for level = 1, 7 do
  local up = gr.node('level' .. level)
  local wood = gr.cylinder('wood')
  wood:set_material(bark)
  wood:rotate('x', -90)
  wood:scale(0.08, 1, 0.08)
  up:add_child(wood)
  for side = -1, 1, 2 do
    local arm = gr.node('arm')
    arm:scale(0.72, 0.72, 0.72)
    arm:rotate('z', side * 33)
    arm:rotate('y', 50)
    arm:translate(0, 0.98, 0)
    arm:add_child(below)
    up:add_child(arm)
  end
  below = up
end
local root = gr.node('root')
root:add_child(below)
root:translate(0, -1.2, 0)
gr.render(root, 'deep', 40, 40, {0.3, 0.2, 5.5}, {0, 0, -1}, {0, 1, 0}, 40, {0.3, 0.3, 0.3},
  {gr.light({4, 6, 8}, {0.8, 0.8, 0.8}, {1, 0, 0})})
