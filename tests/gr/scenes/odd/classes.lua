-- An author who likes objects: methods added to gr, closures, coroutines, goto.
function gr:at(x, y, z) self:translate(x, y, z) return self end
function gr:grow(s) self:scale(s, s, s) return self end
function gr:of(m) self:set_material(m) return self end
function gr:with(...) for i = 1, select('#', ...) do self:add_child((select(i, ...))) end return self end
local shades = setmetatable({}, { __index = function(t, k)
  local m = gr.material({k, 1 - k, 0.5}, {0.3, 0.3, 0.3}, 12)
  t[k] = m
  return m
end })
local spots = coroutine.wrap(function() for i = 0, 9 do coroutine.yield(i % 4 - 1.5, i // 4 - 1) end end)
local root = gr.node('root')
while true do
  local x, y = spots()
  if not x then break end
  if y == 1 and x > 0 then goto done end
  root:with(gr.cube('c'):of(shades[(x + 1.5) / 3]):grow(0.7):at(x, y, 0), gr.sphere('s'):of(shades[0.5]):grow(0.4):at(x, y, 1))
end
::done::
gr.render(root:at(0, 0, -1), 'classes', 48, 32, {0.4, 0.8, 6}, {0, -0.1, -1}, {0, 1, 0}, 45, {0.25, 0.25, 0.25},
  {gr.light({2, 6, 9}, {0.8, 0.8, 0.8}, {1, 0, 0})})
