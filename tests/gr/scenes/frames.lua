-- An animation: transforms add up from picture to picture, shapes and materials come and go.
paint = gr.material({0.7, 0.7, 0.2}, {0.4, 0.4, 0.4}, 15)
other = gr.material({0.2, 0.4, 0.9}, {0.9, 0.9, 0.9}, 60)
root, arm, hand = gr.node('root'), gr.node('arm'), gr.node('hand')
root:add_child(arm)
arm:add_child(hand)
bone = gr.cylinder('bone')
bone:set_material(paint)
bone:scale(0.3, 0.3, 3)
bone:rotate('y', 90)
arm:add_child(bone)
ball = gr.sphere('ball')
ball:set_material(other)
ball:translate(3, 0, 0)
hand:add_child(ball)
tetra = gr.mesh('tetra', 'models/tetra.obj')
tetra:set_material(paint)
tetra:translate(-2, 0, -1)
root:add_child(tetra)
light = gr.light({4, 6, 9}, {0.9, 0.9, 0.9}, {1, 0, 0})

for i = 1, 8 do
  gr.render(root, string.format('frame%02d.png', i), 48, 36, {0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 50,
    {0.2, 0.2, 0.2}, {light})
  arm:rotate('z', 12)
  if i == 2 then ball:set_material(paint) end
  if i == 3 then root:add_child(tetra) end
  if i == 4 then
    more = gr.node('a second hand')
    more:add_child(hand)
    more:rotate('z', 100)
    root:add_child(more)
  end
  if i == 5 then tetra:set_material(other) end
  if i == 6 then tetra:scale(0, 1, 1) end -- flat, so it disappears
  if i == 7 then hand:scale(1, 0.5, 1) end
end
