-- A scene runs this file through dofile.
function ball(name, material, x, y, z)
  local s = gr.sphere(name)
  s:set_material(material)
  s:scale(0.5, 0.5, 0.5)
  s:translate(x, y, z)
  return s
end
