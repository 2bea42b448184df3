-- Carried over from one year to the next: the new unpack under the old name.
local unpack = table.unpack or unpack
local function place(node, t, s) node:scale(unpack(s)) node:translate(unpack(t)) return node end
local m = gr.material({0.4, 0.7, 0.3}, {0.5, 0.5, 0.5}, 25)
local root = gr.node('root')
for i = 1, 5 do
  local s = place(gr.sphere('s' .. i), {i - 3, (i * i) % 4 - 1.5, -i / 2}, {0.3 + i / 10, 0.5, 0.9 - i / 10})
  s:set_material(m)
  root:add_child(s)
end
root:rotate('z', -20)
gr.render(root, 'both.png', 40, 30, {0, 0, 7}, {0, 0, -1}, {0, 1, 0}, 50, {0.3, 0.3, 0.3},
  {gr.light({6, 4, 9}, {0.7, 0.9, 0.7}, {1, 0, 0}), gr.light({-6, 4, 3}, {0.3, 0.2, 0.2}, {0.5, 0.02, 0.001})})
