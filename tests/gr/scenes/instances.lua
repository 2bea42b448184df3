-- Nodes with several parents: later calls on them apply everywhere. Calls as functions and as methods. The nodes'
-- metatable is gr itself, and the scene adds its own functions to it.
stone = gr.material({0.8, 0.7, 0.7}, {0.0, 0.0, 0.0}, 0)
gold = gr.material({0.9, 0.8, 0.4}, {0.8, 0.8, 0.4}, 25)

assert(getmetatable(gr.node('n')) == gr and gr.__index == gr)

function gr.place(self, x, y, z)
  local instance = gr.node('instance')
  instance:add_child(self)
  instance:translate(x, y, z)
  return instance
end
function gr:add_all(list)
  for _, child in ipairs(list) do self:add_child(child) end
end

arc = gr.node('arc')
arc:translate(0, 0, -10)
p1 = gr.cube('p1')
gr.add_child(arc, p1)
p1:set_material(gold)
gr.scale(p1, 0.8, 4, 0.8)
gr.translate(p1, -2.4, 0, -0.4)
p2 = gr.cube('p2')
arc:add_child(p2)
p2:set_material(stone)
p2:scale(0.8, 4, 0.8)
p2:translate(1.6, 0, -0.4)
s = gr.sphere('s')
arc:add_child(s)
s:set_material(stone)
s:scale(4, 0.6, 0.6)
s:translate(0, 4, 0)

ring = gr.node('ring')
for i = 1, 6 do
  local an_arc = gr.node('arc' .. tostring(i))
  an_arc:rotate('Y', (i - 1) * 60)
  ring:add_child(an_arc)
  an_arc:add_child(arc)
end

scene = gr.node('scene')
scene:rotate('X', 23)
scene:add_all { ring, ring:place(0, 4.6, 0) }
scene:add_child(ring) -- twice at one position

p1:set_material(stone)
s:rotate('z', 5)

gr.render(scene, 'instances.png', 64, 64, {0, 2, 30}, {0, 0, -1}, {0, 1, 0}, 50, {0.4, 0.4, 0.4},
  {gr.light({200, 202, 430}, {0.8, 0.8, 0.8}, {1, 0, 0}), gr.light({0, 5, -20}, {0.4, 0.4, 0.8}, {1, 0, 0})})
