-- The first generation: Lua 5.0, models that set globals, faces of any size numbered from 0, transforms in the other order.
require('readobj')
require('models/wedge')
require 'models/wedge.lua' -- the name of a file, as in Lua 5.0

grass = gr.material({0.1, 0.7, 0.1}, {0.0, 0.0, 0.0}, 0)
hide = gr.material({0.84, 0.6, 0.53}, {0.3, 0.3, 0.3}, 20)

scene = gr.node('scene')
scene:rotate('X', 23)

floor = gr.mesh('floor', {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, {{3, 2, 1, 0}})
scene:add_child(floor)
floor:set_material(grass)
floor:scale(30, 30, 30)

wedge:set_material(hide)
for _, place in pairs({ {{4, 0, 5}, 30}, {{-4, 0, 6}, -100} }) do
  local instance = gr.node(string.format('wedge%d', place[2] / 7))
  scene:add_child(instance)
  instance:add_child(wedge)
  instance:translate(unpack(place[1]))
  instance:rotate('Y', place[2])
  instance:scale(3, 2, 1)
end

star = gr.mesh('star', readobj('models/star.obj'))
star:translate(0, 5, 0)
star:scale(4, 4, 4)
star:set_material(hide)
scene:add_child(star)

for word in string.gfind("one two", "%a+") do
  local s = gr.sphere(word)
  s:translate(math.pow(2, 2) * (word == 'one' and 1 or -1.5), table.getn({1, 2, 3}), 0)
  s:rotate('z', 30)
  s:scale(2, 1, 0.5)
  s:set_material(hide)
  scene:add_child(s)
end

table = gr.cube('table') -- the library's name is overwritten
table:translate(-9, 0, 2)
table:scale(3, 1.5, 4)
table:set_material(grass)
scene:add_child(table)

gr.render(scene, 'first', 80, 56, {0, 2, 30}, {0, 0, -1}, {0, 1, 0}, 50, {0.4, 0.4, 0.4},
  {gr.light({200, 202, 430}, {0.8, 0.8, 0.8}, {1, 0, 0})})
