-- Every shape under maps that stretch, mirror and shear it; shapes in shapes.
local red = gr.material({0.9, 0.3, 0.2}, {0.4, 0.4, 0.4}, 12)
local green = gr.material({0.2, 0.8, 0.3}, {0.6, 0.6, 0.6}, 40)
local blue = gr.material({0.3, 0.4, 0.9}, {0, 0, 0}, 0)

local function put(parent, shape, material, ...)
  parent:add_child(shape)
  shape:set_material(material)
  for _, step in ipairs {...} do gr[step[1]](shape, step[2], step[3], step[4]) end
  return shape
end

root = gr.joint('root', {-30, 0, 30}, {0, 0, 0})
root:rotate('x', 20)

put(root, gr.sphere('ellipsoid'), red, {'scale', 2, 0.6, 1}, {'rotate', 'z', 30}, {'translate', -3, 2, 0})
put(root, gr.cube('box'), green, {'translate', -0.5, -0.5, -0.5}, {'scale', 1, 2, 1}, {'rotate', 'Y', 40},
  {'translate', 0, 2, 0})
put(root, gr.cylinder('cylinder'), blue, {'rotate', 'x', -90}, {'scale', 0.8, 1.5, 0.5}, {'translate', 2.5, 1, 0})
put(root, gr.cone('cone'), red, {'scale', 1, 1, 2}, {'rotate', 'X', -80}, {'translate', -3, -2, 0})
put(root, gr.torus('torus', 0.3), blue, {'rotate', 'x', 50}, {'translate', 0.4, 0.6, 1})
put(root, gr.torus('ring', '0.2', 2), red, {'scale', 0.4, 0.6, 0.5}, {'rotate', 'y', 60}, {'translate', 4, 0.5, 0})
put(root, gr.nh_box('nh_box', {0, 0, 0}, 1), green, {'scale', -1, 1, -1.5}, {'translate', 0.5, -2, 0})

-- A scale above a rotation shears the nodes below.
local shear = gr.node('shear')
root:add_child(shear)
shear:scale(2, 0.5, 1)
shear:translate(3, -2, 0)
local turned = gr.node('turned')
shear:add_child(turned)
turned:rotate('z', 405) -- degrees of any size
local ball = put(turned, gr.sphere('sheared'), blue, {'scale', 0.7, 0.7, 0.7})
put(ball, gr.cube('child of a shape'), red, {'scale', 0.8, 0.8, 0.8}, {'translate', 0.6, 0.6, 0.6})
put(turned, gr.cylinder('sheared'), green, {'scale', 0.2, 0.2, 3}, {'rotate', 'y', -765}, {'translate', -0.5, 1.5, 0})

-- Shapes without an extent are invisible.
put(root, gr.sphere('flat'), red, {'scale', 3, 0, 3})
put(root, gr.nh_sphere('point', {0, 0, 0}, 0), red)
put(root, gr.nh_box('nothing', {0, 0, 0}, 0), red)

gr.render(root, 'shapes.png', 72, 48, {0, 1, 12}, {0, -0.1, -1}, {0, 3, 0}, 45, {0.2, 0.25, 0.3},
  {gr.light({5, 8, 9}, {0.8, 0.8, 0.7}, {1, 0, 0}), gr.light({-9, 2, 6}, {0.3, 0.3, 0.5}, {1, 0, 0})})
