--[==[ A student's header:
  require 'readobj' was for the old assignment, unpack({1}) too. gr.mesh('m', {{0,0,0}}, {{0}})
]==]
-- gr.render(scene, 'old', 10, 10)
--[[ two ]] red = gr.material({.9, 0.1, 0x1p-3}, {5e-1, .5, .5}, 2e1) --[[ three
lines ]] scene = gr.node("a -- b [[c]]"); -- ; after ;
do local text = [=[ ]] require unpack( ]=]; ball = gr.sphere 'brackets-less' end
scene:add_child(ball);;; ball:set_material(red) ball:scale(2, 1, .5) ball:rotate('z', 30) ball:translate(1, 0, -5)
gr.render(scene, 'comments', 32, 24, {0, 0, 3}, {0, 0, -800}, {0, 1, 0}, 50, {.3, .3, .3},
  {gr.light({9, 9, 9}, {.9, .9, .9}, {1, 0, 0}),}) --EOF