-- Lights: without fall-off, with an odd one, used twice, in a ball, behind everything, with ignored arguments.
local white = gr.material({0.7, 0.7, 0.7}, {0.6, 0.6, 0.6}, 50, 'shiny', nil, {})
local root = gr.node('root', 'ignored')
local floor = gr.nh_box('floor', {-20, -41, -20}, 40, true)
local ball = gr.nh_sphere('ball', {1, 0, 0}, 1)
local shell = gr.sphere('shell')
shell:translate(-2, 0, 0)
for _, s in ipairs { floor, ball, shell } do s:set_material(white) root:add_child(s) end
local one = gr.light({5, 5, 5}, {0.3, 0.3, 0.3})
gr.render(root, 'lights', 48, 32, {0, 2, 9}, {0, -1, -5}, {0, 1, 0}, 50, {0.1, 0.1, 0.1}, {one, one,
  gr.light({-2, 0, 0}, {5, 5, 5}, {1, 0, 0}), gr.light({-1, 6, -3}, {0.9, 0.2, 0.1}, {0, 0.3, 0}),
  gr.light({0, -30, 0}, {9, 9, 9}, {1, 0, 0}), gr.light({3, 0.2, 2}, {0.2, 0.9, 0.3}, {0, 0, 0.4}, 'soft')}, 16, 'more')
