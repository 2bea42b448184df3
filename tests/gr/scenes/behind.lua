-- The first generation: normals never turn to the eye, insides and backs have only ambient light, all faces shadow.
white = gr.material({0.9, 0.9, 0.9}, {0.5, 0.5, 0.5}, 10)
pink = gr.material({0.9, 0.5, 0.6}, {0.5, 0.5, 0.5}, 30)

root = gr.node('root')
room = gr.nh_sphere('room around the eye', {0, 0, 0}, 40)
room:set_material(pink)
root:add_child(room)

shell = gr.cube('closed, a lamp in it')
shell:set_material(white)
shell:translate(-4, -1, -0.5)
root:add_child(shell)

for i, turn in ipairs { 0, 180 } do -- the same face from its front and from behind
  local face = gr.mesh('face', { {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0} }, { {0, 1, 2, 3} })
  face:set_material(white)
  face:translate(i * 3 - 3.5, 1.4, 0)
  face:rotate('y', turn + 20)
  root:add_child(face)
end
mirrored = gr.mesh('front stays front', { {-1, -1, 0}, {1, -1, 0}, {1, 1, 0} }, { {0, 1, 2} })
mirrored:set_material(pink)
mirrored:translate(0, -1.5, 0.5)
mirrored:scale(-1, 1, 1)
root:add_child(mirrored)
floor = gr.cube('floor')
floor:set_material(white)
floor:translate(-10, -4, -12)
floor:scale(20, 1, 20)
root:add_child(floor)

gr.render(root, 'behind.png', 72, 54, {0, 1, 9}, {0, -0.1, -1}, {0, 1, 0}, 60, {0.25, 0.2, 0.15}, {
  gr.light({3, 9, 7}, {0.8, 0.8, 0.8}, {1, 0, 0}),
  gr.light({-3.5, -0.5, 0}, {1, 1, 1}, {1, 0, 0}),
  gr.light({0, 1, -8}, {0.5, 0.3, 0.3}, {1, 0, 0}),
  gr.light({200, 0, 0}, {1, 1, 1}, {1, 0, 0}),
})
