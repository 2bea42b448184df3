-- Odd views of one scene: leaning up, wide, tall, from within a box, from within a ball.
local m, n = gr.material({0.6, 0.3, 0.3}, {0.4, 0.4, 0.4}, 9), gr.material({0.3, 0.6, 0.3}, {0, 0, 0}, 9)
local root = gr.node('root')
local room = gr.cube('room') room:set_material(n) room:translate(-0.5, -0.5, -0.5) room:scale(20, 12, 20)
local ball = gr.sphere('ball') ball:set_material(m) ball:scale(1, 2, 1) ball:translate(0, 0, -3)
root:add_child(room) root:add_child(ball)
local lights = { gr.light({3, 4, 2}, {0.9, 0.9, 0.9}, {1, 0, 0}) }
local dark = {0.4, 0.4, 0.4}
gr.render(root, 'lean', 30, 20, {0, 0, 5}, {0.1, -0.2, -3}, {1, 1, 0.4}, 60, dark, lights)
gr.render(root, 'wide', 40, 10, {2, 3, 3}, {-2, -3, -6}, {0, 1, 0}, 120, dark, lights)
gr.render(root, 'tall.PNG', 10, 40, {0, 0, 30}, {0, 0, -1e-3}, {0, 1e5, 0}, 20, dark, lights)
gr.render(root, 'inside', 20, 20, {0, 0, -3}, {1, 0, 0}, {0, 0, 1}, 90, dark, lights)
gr.render(root, 'down', 20, 20, {0, 5, -3}, {0, -1, 0}, {0, 0, -1}, 75, dark, lights)
