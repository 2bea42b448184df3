-- The first generation again: readobj, a model fetched by require, a table read from a file, old math functions.
require('readobj')
require('parts/data')
local v, f = readobj('parts/crate.obj')
local root, crate = gr.node('root'), gr.mesh('crate', v, f)
crate:set_material(gr.material({.7, .5, .3}, {0, 0, 0}, 0))
crate:rotate('Y', 35) crate:scale(.8, .8, .8)
root:add_child(crate)
for i = 1, table.getn(DATA) do
  local s = gr.sphere('s' .. i)
  s:set_material(gr.material({math.pow(.9, i), .2, .2}, {.4, .4, .4}, math.pow(2, i)))
  s:translate(unpack(DATA[i]))
  s:scale(.4, .4, .4)
  root:add_child(s)
end
root:scale(1, 1.2, 1)
root:rotate('X', 25)
gr.render(root, 'carried', 40, 40, {0, 0, 8}, {0, 0, -1}, {0, 1, 0}, 45, {.3, .3, .3}, {gr.light({5, 8, 9}, {.8, .8, .8}, {1, 0, 0})})
