-- The plot of glint cost: time against error, both logarithmic, as SVG in the reader's light or dark colours.
local the = ...
local format, log = string.format, math.log

local WIDTH <const>, HEIGHT <const>, LEFT <const>, RIGHT <const>, TOP <const>, BOTTOM <const> = 540, 420, 62, 16, 16, 50
local CHARACTER <const> = 6.6 -- average width of a character

local ENTITIES <const> = { ["<"] = "&lt;", [">"] = "&gt;", ["&"] = "&amp;", ['"'] = "&quot;", ["'"] = "&#39;" }
function the.html(text) return (text:gsub("[<>&\"']", ENTITIES)) end

-- Returns the rows with a point of their own: the script's setting is drawn once.
local function drawn_rows(study)
  local drawn, has_own = {}, false
  for _, row in ipairs(study.rows) do
    local error = row.error
    if error and error.rmse > 0 and row.case.time.median > 0 and not row.other_time and not (row.own and has_own) then
      has_own = has_own or row.own
      drawn[#drawn + 1] = row
    end
  end
  return drawn
end

local function range_of(rows, value)
  local low, high = math.huge, -math.huge
  for _, row in ipairs(rows) do
    local at = log(value(row), 10)
    low, high = math.min(low, at), math.max(high, at)
  end
  local more = 0.08 * (high - low) + 0.05 -- space around the points
  return { low = low - more, high = high + more }
end

local function axis(range, tick)
  for decade = math.floor(range.low), math.ceil(range.high) do
    for _, step in ipairs(range.high - range.low < 3 and { 1, 2, 5 } or { 1 }) do -- ticks at 1, 2, 5, or only decades
      local value = step * 10.0 ^ decade
      local at = log(value, 10)
      if at >= range.low and at <= range.high then tick(value) end
    end
  end
end

-- Returns the SVG element, which is also a complete file; nil if no error is known.
function the.plot(study)
  local rows = drawn_rows(study)
  if #rows == 0 then return nil end
  local time = range_of(rows, function(row) return row.case.time.median end)
  local error = range_of(rows, function(row) return row.error.rmse end)
  local out, taken = {}, {} -- taken: boxes of labels and points

  local function put(...) out[#out + 1] = format(...) end
  local function x_of(ms) return LEFT + (log(ms, 10) - time.low) / (time.high - time.low) * (WIDTH - LEFT - RIGHT) end
  local function y_of(e)
    return HEIGHT - BOTTOM - (log(e, 10) - error.low) / (error.high - error.low) * (HEIGHT - TOP - BOTTOM)
  end
  local function take(x, y, width, height) taken[#taken + 1] = { x = x, y = y, width = width, height = height } end

  local function is_free(x, y, width, height)
    if x < LEFT or x + width > WIDTH or y < 2 or y + height > HEIGHT - BOTTOM then return false end
    for _, t in ipairs(taken) do
      if x < t.x + t.width and t.x < x + width and y < t.y + t.height and t.y < y + height then return false end
    end
    return true
  end

  local function draw_frame()
    axis(time, function(value)
      local at = x_of(value)
      put("<path class='grid' d='M%.1f %dV%d'/><text class='tick' x='%.1f' y='%d' text-anchor='middle'>%g</text>\n",
        at, TOP, HEIGHT - BOTTOM, at, HEIGHT - BOTTOM + 17, value)
    end)
    axis(error, function(value)
      local at = y_of(value)
      put("<path class='grid' d='M%d %.1fH%d'/><text class='tick' x='%d' y='%.1f' text-anchor='end'>%g</text>\n",
        LEFT, at, WIDTH - RIGHT, LEFT - 7, at + 4, value)
    end)
    put("<text class='name' x='%d' y='%d' text-anchor='middle'>milliseconds a frame</text>\n",
      (LEFT + WIDTH - RIGHT) // 2, HEIGHT - 12)
    put("<text class='name' transform='translate(15 %d) rotate(-90)' text-anchor='middle'>error: RMSE of linear "
      .. "light</text>\n", (TOP + HEIGHT - BOTTOM) // 2)
    local floor = 3 * (study.reference and study.reference.rmse or 0)
    if floor > 0 and log(floor, 10) > error.low and log(floor, 10) < error.high then
      local y = y_of(floor)
      local top = y + 17 < HEIGHT - BOTTOM and y or y - 19 -- the label is above the line if it does not fit below
      take(LEFT + 6, top, 230, 17)
      put("<path class='floor' d='M%d %.1fH%d'/><text class='tick' x='%d' y='%.1f'>below: not resolved by the "
        .. "reference</text>\n", LEFT, y, WIDTH - RIGHT, LEFT + 6, top + 14)
    end
  end

  -- Draws the front as steps: the least error for each time.
  local function draw_front()
    local front, before = {}, nil
    for _, row in ipairs(rows) do
      if row.front then front[#front + 1] = row end
    end
    table.sort(front, function(a, b)
      if a.case.time.median == b.case.time.median then return a.index < b.index end
      return a.case.time.median < b.case.time.median
    end)
    put "<path class='front' d='"
    for _, row in ipairs(front) do
      local ms = row.case.time.median
      if not before or ms > before.ms then
        if before then put("L%.1f %.1f", x_of(ms), before.y) end
        local y = y_of(row.error.rmse)
        put("%s%.1f %.1f", before and "L" or "M", x_of(ms), y)
        before = { ms = ms, y = y }
      end
    end
    put "'/>\n"
  end

  local function draw_point(row)
    local t, e = row.case.time, row.error.rmse
    local x, y = x_of(t.median), y_of(e)
    put("<g class='point%s%s' tabindex='0' role='img' data-row='%d' aria-label='%s'><title>%s</title>",
      row.front and " best" or "", row.own and " own" or "", row.index, the.text_of(row), the.text_of(row))
    put("<circle class='reach' cx='%.1f' cy='%.1f' r='14'/>", x, y)
    local spread, bias = row.error.spread or 0, row.error.bias or 0
    put("<path class='spread' d='M%.1f %.1fH%.1fM%.1f %.1fV%.1f'/>", x_of(math.max(t.q1, 1e-6)), y, x_of(math.max(t.q3,
      1e-6)), x, y_of(math.max(e - spread, e / 2)), y_of(e + spread))
    if bias > 0 and log(bias, 10) > error.low then
      put("<path class='spread' d='M%.1f %.1fl8 8m0 -8l-8 8'/>", x - 4, y_of(bias) - 4)
    end
    if row.own then
      put("<path class='mark' d='M%.1f %.1fl8 8l-8 8l-8 -8z'/>", x, y - 8)
    else
      put("<circle class='mark' cx='%.1f' cy='%.1f' r='5'/>", x, y)
    end
    put "</g>\n"
    take(x - 7, y - 7, 14, 14)
  end

  -- Puts the label next to, above or below its point where it fits, or omits it.
  local function draw_label(row)
    local text = row.own and "the script's own" or row.name
    local width, x, y = CHARACTER * #text, x_of(row.case.time.median), y_of(row.error.rmse)
    local places = { { x + 9, y - 14 }, { x + 9, y + 1 }, { x - 9 - width, y + 1, true },
      { x - 9 - width, y - 14, true }, { x - width / 2, y + 8 },
      { x - width / 2, y - 22 } } -- true: right-aligned
    for _, place in ipairs(places) do
      local left, top, ends = table.unpack(place, 1, 3)
      if is_free(left, top, width, 13) then
        put("<text class='label' x='%.1f' y='%.1f'%s>%s</text>\n", ends and left + width or left, top + 11,
          ends and " text-anchor='end'" or "", the.html(text))
        return take(left, top, width, 13)
      end
    end
  end

  put("<svg xmlns='http://www.w3.org/2000/svg' class='glint-plot' viewBox='0 0 %d %d' role='group' "
    .. "aria-label='Time against error of each setting'>\n", WIDTH, HEIGHT)
  put("<style>\n%s</style>\n<rect class='paper' width='%d' height='%d' rx='6'/>\n", study.style, WIDTH, HEIGHT)
  draw_frame()
  draw_front()
  for _, own in ipairs { false, true } do -- the script's own point on top
    for _, row in ipairs(rows) do
      if row.own == own then draw_point(row) end
    end
  end
  for rank = 0, 2 do -- the most important labels first
    for _, row in ipairs(rows) do
      if rank == (row.own and 0 or row.front and 1 or 2) then draw_label(row) end
    end
  end
  put "</svg>\n"
  return table.concat(out)
end
