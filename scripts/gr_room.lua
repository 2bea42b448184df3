-- A room of the gr dialect's variants: planes, an area light and a column: glint --dialect gr scripts/gr_room.lua

gr.options.plane = 'xz' -- a square of edge 1 around the origin; other variants have other squares
gr.options.axis = 'y'   -- the default is z, as in the course

white = gr.material({0.7, 0.7, 0.68}, {0, 0, 0}, 0)
red = gr.material({0.65, 0.15, 0.12}, {0, 0, 0}, 0)
green = gr.material({0.15, 0.5, 0.2}, {0, 0, 0}, 0)
brass = gr.material({0.5, 0.4, 0.15}, {0.6, 0.5, 0.3}, 40)
mirror = gr.material({0.05, 0.05, 0.05}, {0.6, 0.6, 0.6}, 200, 0.7)

room = gr.node('room')

-- A wall is the plane, turned, scaled and moved: transforms act in the order of their calls.
function wall(name, material, axis, degrees, x, y, z)
  local plane = gr.plane(name)
  plane:set_material(material)
  plane:rotate(axis, degrees)
  plane:scale(10, 8, 12)
  plane:translate(x, y, z)
  room:add_child(plane)
end
wall('floor', white, 'x', 0, 0, 0, 0)
wall('ceiling', white, 'x', 180, 0, 8, 0)
wall('back', white, 'x', 90, 0, 4, -6)
wall('left', red, 'z', -90, -5, 4, 0)
wall('right', green, 'z', 90, 5, 4, 0)

function stand(shape, material, x, z, width, height)
  room:add_child(shape)
  shape:set_material(material)
  shape:scale(width, height, width)
  shape:translate(x, 0, z)
end
stand(gr.cylinder('column'), white, -2.2, -2, 1, 3)
stand(gr.cone('cone'), brass, 0.6, 1.8, 0.9, 2.2)

ball = gr.sphere('ball')
room:add_child(ball)
ball:set_material(mirror)
ball:scale(1.5, 1.5, 1.5)
ball:translate(2.4, 1.5, -2)

-- A picture frame, by its corner, the directions of its edges and their lengths.
frame = gr.plane('frame', {-0.8, 3.4, -5.9}, {1, 0, 0}, {0, 1, 0}, 2.4, 1.6)
frame:set_material(brass)
room:add_child(frame)

lamp = gr.area_light({0, 7.6, 2}, {0.75, 0.72, 0.65}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, 3, 64)
gr.render(room, 'gr_room.png', 640, 400, {0, 4, 16}, {0, -0.03, -1}, {0, 1, 0}, 36, {0.25, 0.25, 0.27}, {lamp})
