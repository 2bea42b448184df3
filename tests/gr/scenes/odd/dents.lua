-- Faces with dents, of the first generation.
local root = gr.node('root')
local m = gr.material({0.3, 0.6, 0.8}, {0.3, 0.3, 0.3}, 14)
local star, order = {}, {}
for i = 0, 9 do
  local r = i % 2 == 0 and 2 or 0.8
  star[i + 1] = {r * math.cos(math.pi * i / 5), r * math.sin(math.pi * i / 5), 0}
  order[i + 1] = i
end
local s = gr.mesh('star', star, {order})
local u = gr.mesh('u', {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {0.5, 1, 1}, {0.5, -0.5, 1}, {-0.5, -0.5, 1}, {-0.5, 1, 1}, {-1, 1, 1}},
  {{0, 1, 2, 3, 4, 5, 6, 7}})
for _, n in ipairs({s, u}) do n:set_material(m) n:rotate('x', -20) root:add_child(n) end
gr.render(root, 'dents', 48, 48, {0.3, 0.2, 8}, {0, 0, -1}, {0, 1, 0}, 35, {0.2, 0.2, 0.2}, {gr.light({3, 4, 9}, {0.8, 0.8, 0.8}, {1, 0, 0})})
