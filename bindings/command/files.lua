-- Lists the files that a command's words name: the words themselves, or all files that match a pattern such as
-- "frame_%04d.png".
local the = ...

local GAPS_MAX <const> = 100 -- number of gaps that a message names

-- Returns the numbers of the files that match the pattern, which has one number in the last part of the path.
local function numbers_of(my, pattern)
  local folder, name = pattern:match "^(.*/)([^/]*)$"
  local names, why = my.entries(folder or ".")
  local numbers, before = {}, #(name or pattern):match "^[^%%#]*"
  if not names then my.fail(2, (folder or ".") .. ": " .. why) end
  for _, entry in ipairs(names) do
    local number = math.tointeger(tonumber(entry:match("^%d+", before + 1)))
    if number and my.name_file(pattern, number) == (folder or "") .. entry then numbers[#numbers + 1] = number end
  end
  table.sort(numbers)
  return numbers
end

-- Returns the first and last number that are expected to exist.
local function limits_of(ranges, numbers)
  local first, last = ranges[1] and ranges[1].first or numbers[1], 0
  for _, range in ipairs(ranges) do
    first, last = math.min(first, range.first), math.max(last, range.last)
  end
  return first, (last == 0 or last == math.maxinteger) and numbers[#numbers] or last
end

-- Fails with the numbers that are missing, such as "3, 5-7".
local function check_gaps(my, pattern, numbers, ranges)
  local first, last = limits_of(ranges, numbers)
  local exists, gaps = {}, {}
  for _, number in ipairs(numbers) do exists[number] = true end
  for number = first, last do
    if not exists[number] and my.is_selected(number) then
      local gap = gaps[#gaps]
      if not gap or gap.last < number - 1 then
        gap = { first = number }
        gaps[#gaps + 1] = gap
      end
      gap.last = number
    end
  end
  for i, gap in ipairs(gaps) do gaps[i] = gap.first == gap.last and gap.first or gap.first .. "-" .. gap.last end
  if not gaps[1] then return end
  my.fail(2, pattern .. ": these frames are missing: " .. table.concat(gaps, ", ", 1, math.min(#gaps, GAPS_MAX)))
end

local function list_pattern(my, pattern, ranges)
  local numbers, list = numbers_of(my, pattern), { numbers = {} }
  if numbers[1] then check_gaps(my, pattern, numbers, ranges) end
  for _, number in ipairs(numbers) do
    if my.is_selected(number) then
      list[#list + 1], list.numbers[#list + 1] = my.name_file(pattern, number), number
    end
  end
  if not list[1] then my.fail(2, pattern .. ": there is no such frame") end
  return list
end

-- Returns the number at the end of a file's name, before its extension; -1: there is none.
local function number_of(path, most)
  local name = path:match "[^/]*$"
  local number = math.tointeger(tonumber((name:match "^(.*)%." or name):match "%d+$"))
  return number and number <= most and number or -1
end

local function list_words(my, most)
  local list = { numbers = {} }
  for i, word in ipairs(my.arguments) do
    if word:find "[*?]" and not my.identify(word) then
      my.fail(2, word .. ": no such file; give the names without quotes, or a pattern such as 'frame_%04d.png'")
    end
    list[i], list.numbers[i] = word, number_of(word, most)
  end
  if not list[1] then my.fail(2, "expected finished pictures, or a pattern such as 'frame_%04d.png'") end
  return list
end

-- Returns the files, and in `numbers` the frame number in each name, or -1. Fails if frames are missing, if there are
-- no files, or if the output is one of them.
function the.files(my)
  local ranges, most = my.ranges()
  local word, list = my.arguments[1], nil
  if #my.arguments == 1 and my.is_pattern(word) then
    list = list_pattern(my, word, ranges)
  elseif ranges[1] then
    my.fail(2, "--frames: expected together with a pattern such as 'frame_%04d.png'")
  else
    list = list_words(my, most)
  end
  local target, is_file = my.identify(my.options.output)
  for _, file in ipairs(is_file and list or {}) do
    if my.identify(file) == target then
      my.fail(2, "-o: '" .. my.options.output .. "' is one of the input pictures; give another file")
    end
  end
  return list
end
