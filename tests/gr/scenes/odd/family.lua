-- Shapes that carry shapes, and a material that is set late, set again, and set by a function.
local function paint(...) for _, n in ipairs({...}) do gr.set_material(n, gr.material({0.2, 0.2, 0.9}, {0, 0, 0}, 1)) end end
body, head, hat, arm = gr.sphere('body'), gr.sphere('head'), gr.cone('hat'), gr.cube('arm')
body:add_child(head) head:add_child(hat) body:add_child(arm) body:add_child(arm)
paint(body, head, hat, arm)
gr.scale(body, 1, 1.4, 1)
head:scale(0.5, 0.4, 0.5) head:translate(0, 1.3, 0)
hat:rotate('x', -90) hat:scale(1.3, 1.5, 1.3) hat:translate(0, 0.7, 0)
arm:scale(1.2, 0.2, 0.3) arm:rotate('z', 35) arm:translate(0.7, 0, 0)
head:set_material(gr.material({0.9, 0.7, 0.6}, {0.3, 0.3, 0.3}, 8))
body:rotate('Y', 200) body:rotate('X', '10')
gr.render(body, 'family', 32, 40, {0, 0.5, 8}, {0, 0, -1}, {0, 1, 0}, 40, {0.3, 0.3, 0.3},
  {gr.light({2, 8, 9}, {0.9, 0.9, 0.9}, {1, 0, 0})})
