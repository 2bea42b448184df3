-- Rotations between stretches make shears: each round shape under a shear, in deep groups, some lit from behind.
local m = gr.material({0.8, 0.5, 0.3}, {0.5, 0.5, 0.5}, 18)
local root = gr.node('root')
local makers = {gr.sphere, gr.cylinder, gr.cone, gr.cube}
for i, make in ipairs(makers) do
  local shape, outer = make('shape' .. i), gr.node('outer' .. i)
  shape:set_material(m)
  shape:scale(1.4, 0.5, 1) shape:rotate('z', 35) shape:scale(0.5, 1.3, 0.8) shape:rotate('x', 25 * i)
  outer:add_child(shape)
  outer:scale(1, 1, 2) outer:rotate('y', 40) outer:translate(i % 2 * 3 - 1.5, i > 2 and -1.4 or 1.4, 0)
  root:add_child(outer)
end
gr.render(root, 'sheared', 48, 40, {0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 42, {0.2, 0.2, 0.2},
  {gr.light({-8, 2, 4}, {0.6, 0.6, 0.6}, {1, 0, 0}), gr.light({3, 3, -9}, {0.6, 0.6, 0.9}, {1, 0, 0})})
