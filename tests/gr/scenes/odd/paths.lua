-- .obj files found by many kinds of paths; the second generation.
local mat = gr.material({0.2, 0.6, 0.7}, {0.4, 0.4, 0.4}, 30)
local root = gr.node('root')
local where = {'models/tetra.obj', '../models/tetra.obj', './parts/crate.obj', 'parts/../parts/crate.obj'}
for i, file in ipairs(where) do
  local m = gr.mesh('m' .. i, file)
  gr.set_material(m, mat)
  m:scale(0.7, 0.7, 0.7) m:rotate('y', 20 * i) m:translate(2.2 * i - 5.5, i % 2, 0)
  root:add_child(m)
end
gr.render(root, 'paths.png', 48, 24, {0, 1, 9}, {0, 0, -1}, {0, 1, 0}, 40, {0.2, 0.2, 0.2},
  {gr.light({3, 8, 10}, {0.9, 0.9, 0.9}, {1, 0, 0})})
