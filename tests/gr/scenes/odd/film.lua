-- A loop of pictures of one graph that turns; materials come and go.
local root, arm = gr.node('root'), gr.joint('arm', {-90, 0, 90}, {-90, 0, 90})
local tip = gr.nh_box('tip', {1, -0.25, -0.25}, 0.5)
root:add_child(arm) arm:add_child(tip)
local hub = gr.cylinder('hub') hub:set_material(gr.material({0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, 40)) root:add_child(hub)
for i = 0, 3 do
  tip:set_material(gr.material({i / 3, 0.4, 1 - i / 3}, {0.3, 0.3, 0.3}, 10 ^ i))
  gr.render(root, ('turn%02d.png'):format(i), 24, 24, {0, 0, 6}, {0, 0, -1}, {0, 1, 0}, 40, {0.2, 0.2, 0.2},
    i == 2 and {} or {gr.light({3, 3, 6}, {0.8, 0.8, 0.8}, {1, 0, 0})})
  arm:rotate('z', 40) arm:scale(1.1, 0.95, 1)
  if i == 1 then arm:add_child(hub) end
end
