-- Random gr scenes: a graph whose nodes have several parents, every shape, maps that stretch, mirror and shear.
--   random_scene(seed, models) -> text, order     models: the folder of tests/gr/scenes/models
-- No two shapes have coincident surfaces, where two correct renderers may show either one.
local TETRA = "{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}}, {{0, 1, 3}, {0, 2, 1}, {0, 3, 2}, {1, 2, 3}}"

local function between(a, b) return a + (b - a) * math.random() end
local function chance(share) return math.random() < share end
local function vector(a, b) return ("{%.17g, %.17g, %.17g}"):format(between(a, b), between(a, b), between(a, b)) end

local steps = {
  function() return ("translate(%.17g, %.17g, %.17g)"):format(between(-1.5, 1.5), between(-1.5, 1.5), between(-1.5, 1.5)) end,
  function()
    return ("scale(%.17g, %.17g, %.17g)"):format(between(0.4, 1.6) * (chance(0.15) and -1 or 1), between(0.4, 1.6),
      chance(0.5) and 1 or between(0.4, 1.6))
  end,
  function()
    return ("rotate('%s', %.17g)"):format(("xYz"):sub(math.random(3)):sub(1, 1),
      chance(0.5) and 15 * math.random(-30, 30) or between(-400, 400))
  end,
}

local function random_shape(first)
  local shapes = {
    "gr.sphere('s')", "gr.cube('c')", "gr.cylinder('y')", "gr.cone('k')", "gr.torus('t', 0.35)",
    ("gr.nh_sphere('ns', %s, %.17g)"):format(vector(-1, 1), between(0.3, 1.2)),
    ("gr.nh_box('nb', %s, %.17g)"):format(vector(-1, 0.5), between(0.3, 1.2)),
    first and "gr.mesh('m', " .. TETRA .. ")" or "gr.mesh('m', models .. '/tetra.obj')",
  }
  return shapes[math.random(#shapes)]
end

local function random_light()
  return ("gr.light(%s, %s, {%.17g, %.17g, %.17g})"):format(vector(-9, 9), vector(0, 1), between(0.5, 1),
    chance(0.5) and 0 or between(0, 0.2), chance(0.5) and 0 or between(0, 0.05))
end

return function(seed, models)
  math.randomseed(seed)
  local first = chance(0.5)
  local lines = { ("models = %q"):format(models), first and "u = unpack({1})" or "u = table.unpack({1})" }
  local function add(...) lines[#lines + 1] = string.format(...) end
  for i = 1, 3 do
    local shininess = chance(0.3) and math.random(0, 3) or between(0.1, 200)
    add("m%d = gr.material(%s, %s, %.17g)", i, vector(0, 1), chance(0.3) and "{0, 0, 0}" or vector(0, 1), shininess)
  end
  for i = 1, math.random(2, 9) do
    local group = chance(0.3)
    add("n%d = %s", i, group and "gr.node('g')" or random_shape(first))
    if not group then add("n%d:set_material(m%d)", i, math.random(3)) end
    add("n%d:%s", i, steps[2]())
    for _ = 1, math.random(0, 3) do add("n%d:%s", i, steps[math.random(3)]()) end
    add("n%d:%s", i, steps[1]())
    for _ = 1, i > 1 and math.random(1, 2) or 0 do add("n%d:add_child(n%d)", math.random(i - 1), i) end
  end
  local lights = {}
  for i = 1, math.random(0, 3) do lights[i] = random_light() end
  add("gr.render(n1, 'random', 32, 24, {%.17g, %.17g, 9}, {0, 0, -1}, %s, %.17g, %s, {%s})", between(-1, 1), between(-1, 1),
    vector(-1, 1), between(30, 60), vector(0, 0.4), table.concat(lights, ", "))
  return table.concat(lines, "\n") .. "\n", first and "post" or "pre"
end
