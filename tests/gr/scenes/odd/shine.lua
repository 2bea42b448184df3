-- Highlights from none to very narrow, and colours above one.
local root = gr.node('root')
for i, s in ipairs({0, 0.1, 1, 10, 1000, 5e7}) do
  local ball = gr.nh_sphere('ball', {(i - 1) % 3 * 2.2 - 2.2, i > 3 and -1.1 or 1.1, 0}, 1)
  ball:set_material(gr.material({0.1 * i, 0.1, 0.1}, s == 0 and {0, 0, 0} or {0.8, 1.5, 0.8}, s))
  root:add_child(ball)
end
gr.render(root, 'shine', 48, 32, {0, 0, 9}, {0, 0, -1}, {0, 1, 0}, 35, {1.5, 0.2, 0.2},
  {gr.light({-4, 6, 12}, {0.9, 0.9, 0.9}, {1, 0, 0}), gr.light({0, 0, 9}, {0.3, 0.3, 0.3}, {1, 0, 0})})
