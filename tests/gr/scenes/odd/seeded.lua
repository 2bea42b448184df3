-- A random heap, with a seed; all three forms of math.random.
math.randomseed(12.75)
local root = gr.node('heap')
local kinds = {'sphere', 'cube', 'cone', 'cylinder'}
for i = 1, 40 do
  local s = gr[kinds[math.random(#kinds)]]('s' .. i)
  s:set_material(gr.material({math.random(), math.random(), math.random()}, {0.2, 0.2, 0.2}, math.random(5, 50)))
  s:scale(0.3 + math.random() / 2, 0.3 + math.random() / 2, 0.4)
  s:rotate(({'x', 'y', 'z'})[math.random(1, 3.9)], math.random(360))
  s:translate(math.random(-30, 30) / 10, math.random(-20, 20) / 10, math.random(-30, 0) / 10)
  root:add_child(s)
end
gr.render(root, 'seeded', 48, 36, {0, 0, 8}, {0, 0, -1}, {0, 1, 0}, 45, {0.3, 0.3, 0.3}, {gr.light({5, 5, 9}, {0.8, 0.8, 0.8}, {1, 0, 0})})
