-- Materials and lights at their limits: exponents, fall-offs, one light several times, no light at all.
root = gr.node('root')
for i, shininess in ipairs { 0, 0.1, 1, 25, 900, 5e7 } do
  local ball = gr.sphere('ball' .. i)
  local ks = shininess == 0 and 0 or 0.8
  ball:set_material(gr.material({0.2 + 0.1 * i, 0.5, 0.9 - 0.1 * i}, {ks, ks, ks}, shininess))
  ball:translate(2.2 * i - 7.7, 1.2 * (i % 2) - 0.6, 0)
  root:add_child(ball)
end
board = gr.nh_box('board', {-20, -42, -20}, 40)
board:set_material(gr.material({1.5, 1.2, 0.4}, {0, 0, 0}, 7))
root:add_child(board)

lamp = gr.light({2, 4, 5}, {9, 8, 7}, {0, 0, 1})
bare = gr.light({-6, 3, 3}, {0.3, 0.3, 0.3})
far = gr.light({0, 60, 20}, {1, 1, 1}, {'1', 0.05, 0})
where = { {0, 2.5, 16}, {0, -0.15, -1}, {0, 1, 0} }

gr.render(root, 'lamps1', 84, 40, where[1], where[2], where[3], 38, {0.1, 0.1, 0.1}, {lamp, bare, far})
gr.render(root, 'lamps2', 84, 40, where[1], where[2], where[3], 38, {0.1, 0.1, 0.1}, {bare, lamp, bare, bare})
gr.render(root, 'lamps3', 84, 40, where[1], where[2], where[3], 38, {0.7, 0.6, 0.5}, {})
gr.render(gr.node('nothing'), 'lamps4', 84, 40, where[1], where[2], where[3], 38, {0.1, 0.1, 0.1}, {lamp})
