-- Numbers as strings wherever gr accepts numbers.
m = gr.material({'0.3', 0.5, '7e-1'}, {'.5', '.5', '.5'}, '20')
s = gr.nh_sphere('s', {'0', '0.5', '-1'}, '1.25')
b = gr.nh_box('b', {'-2', -1, '-1'}, 1)
s:set_material(m) b:set_material(m)
s:rotate('Z', '-30') s:scale('1.5', '1', '0x1') b:translate('0.25', 0, ' 0.5 ')
r = gr.node('r') r:add_child(s) r:add_child(b)
gr.render(r, 'strings', '40.9', '30', {'0', 0, '7'}, {0, '0', -1}, {0, '1', 0}, '50', {'0.3', '.3', .3},
  {gr.light({'5', '5', '5'}, {'.8', '.8', '.8'}, {'1', '0', '0.005'})})
