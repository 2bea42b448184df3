-- Finds numbers of a scene from a picture of it, by Gauss-Newton. The passes d:NAME are the derivatives of every pixel
-- by each number, and each step goes to the predicted minimum of the difference. Damping by Levenberg and Marquardt
-- shortens steps that would increase the difference.
--     local fit = require "glint.fit"
--     local found = fit.run {
--       target = "photo.png",                              -- or a .pfm, a picture of glint.read_image, an image, or an
--                                                          -- array as of image:array
--       start = { { "lamp_x", -1 }, { "power", 1, least = 0.01 } },
--       render = function(v, passes)                       -- numbers by their names
--         lamp.x, lamp.intensity = v.lamp_x, v.power
--         return scene:render { width = 160, height = 120, passes = passes }
--       end,
--     }
--     print(found.values.lamp_x, found.uncertainty.lamp_x, found.converged)
-- The uncertainty of a number is its standard deviation, if the remaining differences are independent noise: it shows
-- how well the picture determines the number. `found.undetermined` names numbers that the picture cannot tell apart.
-- Values of a .png at full white are clipped and ignored.
local glint = require "glint"
local fit = {}

local FIELDS = { target = true, start = true, render = true, steps = true, tolerance = true, report = true }
local DAMPING_MAX = 1e12 -- more damping means that no step helps

local function fail(...) error("fit: " .. string.format(...), 0) end

-- Returns the target's numbers, and a factor for each: 0 for those that are clipped.
local function read_target(target)
  local is_png = type(target) == "string" and target:lower():match "%.png$"
  local picture = type(target) == "string" and glint.read_image(target) or target
  local is_array = tostring(picture):find "^array of "
  local list = is_array and picture or picture:array()
  local form = is_array and tostring(list) or ("%d x %d"):format(picture.width, picture.height)
  return { list = list, counts = is_png and 1 - list:floor() or list * 0 + 1, form = form,
    width = not is_array and picture.width }
end

local function total(array)
  local sum = array:sum()
  return sum.x + sum.y + sum.z
end

-- Returns the inverse of a symmetric matrix; nil if it is singular.
local function inverse(a)
  local n, m, out = #a, {}, {}
  for i = 1, n do
    m[i] = { table.unpack(a[i]) }
    for j = 1, n do m[i][n + j] = i == j and 1 or 0 end
  end
  for i = 1, n do
    local best = i
    for k = i + 1, n do best = math.abs(m[k][i]) > math.abs(m[best][i]) and k or best end
    m[i], m[best] = m[best], m[i]
    local pivot = m[i][i]
    if pivot == 0 or pivot ~= pivot then return nil end
    for j = 1, 2 * n do m[i][j] = m[i][j] / pivot end
    for k = 1, n do
      local f = m[k][i]
      for j = 1, k ~= i and 2 * n or 0 do m[k][j] = m[k][j] - f * m[i][j] end
    end
  end
  for i = 1, n do out[i] = { table.unpack(m[i], n + 1, 2 * n) } end
  return out
end

-- Returns the sum of the squared differences between a picture and the target, and the normal equations.
local function equations(image, target, names)
  local got, list = image:array(), target.list
  if #got ~= #list or list.width ~= 3 or target.width and target.width ~= image.width then
    fail("the target is %s, the picture %d x %d", target.form, image.width, image.height)
  end
  local rest, slopes, a, b = (list - got) * target.counts, {}, {}, {}
  for i, name in ipairs(names) do
    slopes[i], a[i] = image:array("d:" .. name) * target.counts, {}
    b[i] = total(slopes[i] * rest)
    for j = 1, i do
      a[i][j] = total(slopes[i] * slopes[j])
      a[j][i] = a[i][j]
    end
  end
  local sum, used = total(rest * rest), total(target.counts)
  return { a = a, b = b, sum = sum, used = used, error = math.sqrt(sum / math.max(used, 1)) }
end

-- Returns the numbers after a damped step: within their limits; a positive number falls at most to a quarter.
local function step(v, e, damping, entries)
  local a, next = {}, {}
  for i = 1, #v do
    a[i] = { table.unpack(e.a[i]) }
    a[i][i] = a[i][i] * (1 + damping)
    if a[i][i] == 0 then fail("the picture does not change with %s", entries[i][1]) end
  end
  local inverted = inverse(a)
  if not inverted then return nil end
  for i = 1, #v do
    local by = 0
    for j = 1, #v do by = by + inverted[i][j] * e.b[j] end
    local least, most = entries[i].least or -math.huge, entries[i].most or math.huge
    next[i] = math.min(math.max(v[i] + by, least, v[i] > 0 and v[i] / 4 or -math.huge), most)
  end
  return next
end

local function check(options)
  if type(options) ~= "table" then fail("a table { target, start, render } expected, got %s", type(options)) end
  for name in pairs(options) do
    if not FIELDS[name] then
      fail("%s: no such option; the options are target, start, render, steps, tolerance, report", name)
    end
  end
  if options.target == nil then fail("target: a file name, a picture, an image or an array expected, got nil") end
  if type(options.render) ~= "function" then
    fail("render: function(values, passes) expected, got %s", type(options.render))
  end
  if type(options.start) ~= "table" or #options.start == 0 then fail("start: a list of { name, number } expected") end
  for i, entry in ipairs(options.start) do
    if type(entry) ~= "table" or type(entry[1]) ~= "string" or type(entry[2]) ~= "number" then
      fail("start[%d]: { name, number } expected", i)
    end
  end
end

local function by_name(names, v)
  local out = {}
  for i, name in ipairs(names) do out[name] = v[i] end
  return out
end

-- Below this share of its squared slope, other numbers together have the same effect on the picture as a number: slopes
-- have 24 bits.
local SAME <const> = 2.0 ^ -36

local function submatrix(a, rows)
  local out = {}
  for i, row in ipairs(rows) do
    out[i] = {}
    for j, column in ipairs(rows) do out[i][j] = a[row][column] end
  end
  return out
end

-- Describes a change of the numbers that does not change the picture: by[i] is the change of number i.
local function describe(by, names, v)
  local changed = {}
  for i = 1, #names do
    if by[i] and math.abs(by[i]) > 1e-3 * math.max(math.abs(v[i]), 1e-9) then changed[#changed + 1] = i end
  end
  if #changed == 1 then return "the picture does not change with " .. names[changed[1]] end
  local i, j = changed[1], changed[2]
  local function is_near(x, want) return math.abs(x - want) < 1e-3 end
  local what = "a combination"
  if #changed == 2 then
    local ratio, share = by[i] / by[j], by[i] / v[i] / (by[j] / v[j])
    local is_sum, is_product = is_near(math.abs(ratio), 1), is_near(math.abs(share), 1)
    if is_sum ~= is_product then -- otherwise both describe a small change equally well
      what = is_sum and (ratio < 0 and "the sum" or "the difference") or share < 0 and "the product" or "the ratio"
    end
  end
  local list = {}
  for k, number in ipairs(changed) do list[k] = names[number] end
  local last = table.remove(list)
  return "only " .. what .. " of " .. table.concat(list, ", ") .. " and " .. last
end

-- Returns standard deviations: the variance of the residual times the inverse of the normal equations; math.huge for
-- numbers that the picture does not determine. Also returns a sentence for each direction that it does not determine.
local function uncertainties(e, names, v)
  local count, rows, out, sentences, free = #v, {}, {}, {}, {}
  local scale, c = {}, {}
  for i = 1, count do scale[i] = math.sqrt(e.a[i][i]) end
  for i = 1, count do
    c[i] = {}
    for j = 1, count do c[i][j] = scale[i] > 0 and scale[j] > 0 and e.a[i][j] / scale[i] / scale[j] or 0 end
  end
  for j = 1, count do -- takes number j as a combination of the rows before it, as well as that is possible
    local inverted, by, rest = inverse(submatrix(c, rows)), {}, c[j][j]
    for i, row in ipairs(rows) do
      local share = 0
      for k, other in ipairs(rows) do share = share + inverted[i][k] * c[other][j] end
      by[row], rest = -share / scale[row], rest - share * c[row][j]
    end
    if rest > SAME then
      rows[#rows + 1] = j
    else
      by[j] = scale[j] > 0 and 1 / scale[j] or math.max(math.abs(v[j]), 1)
      sentences[#sentences + 1], free[j] = describe(by, names, v), true
      for i, change in pairs(by) do
        if math.abs(change) > 1e-3 * math.max(math.abs(v[i]), 1e-9) then free[i] = true end
      end
    end
  end
  local inverted, variance = inverse(submatrix(e.a, rows)), e.sum / math.max(e.used - count, 1)
  for i = 1, count do out[i] = math.huge end
  for k, i in ipairs(rows) do
    if not free[i] and inverted then out[i] = math.sqrt(math.max(variance * inverted[k][k], 0)) end
  end
  return out, sentences
end

local function is_small(v, tried, tolerance)
  for i = 1, #v do
    if math.abs(tried[i] - v[i]) > tolerance * math.max(math.abs(v[i]), tolerance) then return false end
  end
  return true
end

--- Fits numbers to a picture.
---@param options table  target; start, a list of { name, number, least = x, most = y }; render(values, passes), which
--- sets the scene and returns its image with these passes; steps (20); tolerance (1e-6), the share of a number below
--- which a step has converged; report(k, values, error, damping), called at each step
---@return table found  values and uncertainty by names; error, the root of the mean square difference; steps;
--- converged; undetermined, a list of sentences such as "only the product of power and diffuse", empty if the picture
--- determines every number. The uncertainty of the others is math.huge, and the fit has not converged
function fit.run(options)
  check(options)
  local entries, names, v = options.start, {}, {}
  for i, entry in ipairs(entries) do names[i], v[i] = entry[1], entry[2] end
  local target, tolerance = read_target(options.target), options.tolerance or 1e-6
  local passes = "d:" .. table.concat(names, ",d:")
  local function look(numbers)
    local variables = {}
    for i, name in ipairs(names) do variables[name] = glint.variable(name, numbers[i]) end
    local image = options.render(variables, passes)
    if not image then
      fail("render: an image expected, got nil; do not use --frames or --shard, as all frames are needed")
    end
    return equations(image, target, names)
  end
  local damping, e, steps, converged = 1e-2, look(v), 0, false
  local function report()
    if options.report then options.report(steps, by_name(names, v), e.error, damping) end
  end
  report()
  while steps < (options.steps or 20) and not converged and e.error > 1e-7 do
    steps = steps + 1
    local tried = step(v, e, damping, entries)
    local there = tried and look(tried)
    converged = there and is_small(v, tried, tolerance) and there.error <= e.error * (1 + tolerance)
    if there and there.error < e.error then
      v, e, damping = tried, there, damping / 10
    else
      damping = damping * 10
    end
    report()
    if damping > DAMPING_MAX then break end
  end
  local uncertainty, undetermined = uncertainties(e, names, v)
  return { values = by_name(names, v), uncertainty = by_name(names, uncertainty), error = e.error, steps = steps,
    undetermined = undetermined, converged = #undetermined == 0 and (converged or e.error <= 1e-7) }
end

return fit
