-- Spheres outside any hierarchy: a view vector that is not a unit vector, strings as numbers, extra arguments.
mat1 = gr.material({0.7, 1.0, 0.7}, {0.5, 0.7, 0.5}, 25)
mat2 = gr.material({"0.5", 0.5, 0.5}, {0.5, 0.7, 0.5}, "25", 0)
mat3 = gr.material({1.0, 0.6, 0.1}, {0.5, 0.7, 0.5}, 25, 10000000, {1, 2})

scene_root = gr.node('root')

s1 = gr.nh_sphere('s1', {0, 0, -400}, 100)
scene_root:add_child(s1)
s1:set_material(mat1)

s2 = gr.nh_sphere('s2', {200, "50", -100}, "150", 'extra')
scene_root:add_child(s2, 'extra')
s2:set_material(mat1)

s3 = gr.nh_sphere('s3', {0, -1200, -500}, 1000)
scene_root:add_child(s3)
s3:set_material(mat2)

s4 = gr.nh_sphere('s4', {-100, 25, -300}, -50) -- only the square of the radius matters
scene_root:add_child(s4)
s4:set_material(mat3)

s5 = gr.nh_sphere('', {0, 100, -250}, 25)
scene_root:add_child(s5)
s5:set_material(mat1)
s5:scale(1.5, 0.5, "1") -- these spheres take transforms, too
s5:translate(0, '60', 0)

white_light = gr.light({-100.0, 150.0, 400.0}, {0.9, 0.9, 0.9}, {1, 0, 0}, 0.5)
orange_light = gr.light({400.0, 100.0, 150.0}, {0.7, 0.0, 0.7}, {1, 0, 0}, 4, {0, 1, 0})

gr.render(scene_root, 'spheres.png', 64.9, '64', {0, 0, 800}, {0, 0, -800}, {0, 1, 0}, 50,
  {0.3, 0.3, 0.3}, {white_light, orange_light}, 1, 'two', {3})
