require('parts/house')
scene = gr.node('street')
for i = -1, 1 do
  local one = gr.node('plot' .. i)
  one:add_child(house)
  one:translate(2.6 * i, 0, -math.abs(i))
  one:rotate('Y', 25 * i)
  scene:add_child(one)
end
gr.render(scene, 'nested.png', 48, 32, {0, 2, 9}, {0, -1, -6}, {0, 1, 0}, 45, {0.25, 0.25, 0.3},
  {gr.light({-5, 10, 8}, {0.8, 0.8, 0.7}, {1, 0, 0})})
