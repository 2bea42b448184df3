-- A scene of the gr dialect, as its course's students write them: glint --dialect gr scripts/gr_scene.lua
-- A temple: its twelve columns are one shared node. The vase gets its transforms after it was added to the temple.

stone = gr.material({0.75, 0.72, 0.66}, {0.1, 0.1, 0.1}, 10)
sand = gr.material({0.55, 0.47, 0.35}, {0, 0, 0}, 0)
bronze = gr.material({0.5, 0.3, 0.12}, {0.8, 0.55, 0.3}, 35)
glaze = gr.material({0.1, 0.3, 0.45}, {0.8, 0.8, 0.8}, 90)

-- Transforms act in the order in which they are called.
column = gr.node('column')
shaft = gr.cylinder('shaft')
column:add_child(shaft)
shaft:set_material(stone)
shaft:rotate('x', -90)
shaft:scale(0.4, 4, 0.4)

for i, height in ipairs({0, 3.8}) do
  local block = gr.cube('block' .. i)
  column:add_child(block)
  block:set_material(stone)
  block:translate(-0.5, 0, -0.5)
  block:scale(1.2, 0.3, 1.2)
  block:translate(0, height, 0)
end

temple = gr.node('temple')
for i = 1, 12 do
  local place = gr.node('place' .. i)
  temple:add_child(place)
  place:add_child(column)
  place:translate(5, 0, 0)
  place:rotate('y', 30 * i + 15)
end

roof = gr.cone('roof')
temple:add_child(roof)
roof:set_material(bronze)
roof:rotate('x', -90)
roof:scale(6.2, 2.6, 6.2)
roof:translate(0, 4.1, 0)

-- A vase on its stand: an ellipsoid, and a cone that is its child and so has its transform.
stand = gr.nh_box('stand', {-0.7, 0, -0.7}, 1.4)
temple:add_child(stand)
stand:set_material(stone)
vase = gr.sphere('vase')
temple:add_child(vase)
vase:set_material(glaze)
neck = gr.cone('neck')
vase:add_child(neck)
neck:set_material(glaze)

floor = gr.nh_box('floor', {-40, -80, -40}, 80)
floor:set_material(sand)

scene = gr.node('scene')
scene:add_child(temple)
scene:add_child(floor)

neck:rotate('x', 90)
neck:scale(0.6, 0.9, 0.6)
neck:translate(0, 1.6, 0)
vase:scale(0.7, 0.8, 0.7)
vase:translate(0, 2.2, 0)

sun = gr.light({9, 22, 34}, {0.8, 0.76, 0.66}, {1, 0, 0})
sky = gr.light({-20, 12, 25}, {0.22, 0.26, 0.34}, {1, 0, 0})
gr.render(scene, 'gr_scene.png', 640, 400, {0, 5.5, 21}, {0, -0.15, -1}, {0, 1, 0}, 34, {0.3, 0.32, 0.36}, {sun, sky})
