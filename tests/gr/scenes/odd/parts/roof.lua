tiles = gr.material({0.7, 0.2, 0.15}, {0.2, 0.2, 0.2}, 12)
function roof(other)
  assert(other)
  local r = gr.mesh('roof', {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1.2, 0}},
    {{0, 1, 2, 3}, {4, 1, 0}, {4, 2, 1}, {4, 3, 2}, {4, 0, 3}})
  r:set_material(tiles)
  r:translate(0, 0.56, 0)
  return r
end
