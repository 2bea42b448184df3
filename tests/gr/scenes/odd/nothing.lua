-- Invisible objects (flattened, without size, in a group of scale 0), empty groups, and one visible ball.
local m = gr.material({0.9, 0.8, 0.2}, {0.2, 0.2, 0.2}, 5)
local root, dead = gr.node('root'), gr.node('dead')
local flat, speck, ball = gr.sphere('flat'), gr.nh_sphere('speck', {0, 0, 0}, 0), gr.sphere('ball')
flat:scale(2, 0, 2)
dead:scale(0, 0, 0)
for _, n in ipairs { flat, speck, ball } do n:set_material(m) root:add_child(n) end
dead:add_child(ball)
root:add_child(dead)
root:add_child(gr.node('empty'))
ball:translate(0.5, 0.25, 0)
gr.render(root, 'nothing', 24, 24, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 45, {0.2, 0.2, 0.2}, {gr.light({3, 3, 5}, {0.8, 0.8, 0.8}, {1, 0, 0})})
gr.render(gr.node('none'), 'empty', 8, 8, {0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 45, {0.2, 0.2, 0.2}, {})
