-- A scene that overwrites global names that other code needs.
type, pairs, table, string, print, error = nil, nil, {1, 2, 3}, 'text', 0, {}
x, y, z, node, mesh, check = 1, 2, 3, 4, 5, 6
local m = gr.material({0.5, 0.5, 0.9}, {0.5, 0.5, 0.5}, 33)
local s = gr.mesh('m', 'models/star.obj')
s:set_material(m) s:rotate('y', 30)
math = nil
gr.render(s, 'globals', 24, 24, {0, 0, 6}, {0, 0, -1}, {0, 1, 0}, 40, {0.3, 0.3, 0.3}, {gr.light({3, 3, 9}, {0.8, 0.8, 0.8}, {1, 0, 0})})
