-- The first generation with a library of its own: old names, several results, faces of any size.
function vec(...) return {unpack({...})} end
function gr.box3(name, a, b, m)
  local box = gr.cube(name)
  box:set_material(m)
  box:translate(unpack(a))
  box:scale(b[1] - a[1], b[2] - a[2], b[3] - a[3])
  return box
end
local stone = gr.material(vec(.6, .6, .65), vec(0, 0, 0), 0)
local gold = gr.material(vec(.8, .65, .2), vec(.9, .8, .4), 60)
local function prism(n, r)
  local v, f, top, bottom = {}, {}, {}, {}
  for i = 0, n - 1 do
    local c, s = math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)
    table.insert(v, {r * c, 0, r * s})
    table.insert(v, {r * c, 1, r * s})
    table.insert(bottom, 2 * i)
    table.insert(top, 1, 2 * i + 1)
    local j = math.mod(i + 1, n)
    f[table.getn(f) + 1] = {2 * i, 2 * i + 1, 2 * j + 1, 2 * j}
  end
  table.insert(f, top) table.insert(f, bottom)
  return v, f
end
scene = gr.node('scene')
scene:rotate('x', 20)
for n in string.gfind("3 5 8", "%d") do
  local p = gr.mesh('prism' .. n, prism(n + 0, 1))
  p:set_material(gold)
  p:translate((n - 5) * 1.3, 0, 0)
  scene:add_child(p)
end
scene:add_child(gr.box3('floor', vec(-6, -0.6, -3), vec(6, -0.1, 3), stone))
gr.render(scene, string.format('helpers_%d', 7.9), 48, 30, vec(0, 1, 12), vec(0, 0, -1), vec(0, 1, 0), 40, vec(.2, .2, .2),
  {gr.light(vec(4, 9, 6), vec(.8, .8, .8), vec(1, 0, 0))})
