-- make bench: all sides, one table, one CSV.   lua5.4 tests/bench/bench.lua BUILD COMPILER [PART,PART...|all] [RUNS]
--
-- Parts: frame reuse jobs many lamps ways solids programs encode stages peers, and slow (minutes), which runs only on
-- request. All measurements except the slow renderers run at least 7 times, in a random order in each round. The
-- table shows medians and quartiles. The part `readme`, on by default, prints the README's table.
package.path = "tests/bench/?.lua;" .. package.path
local cases, measure = require "cases", require "measure"

local build, compiler, selection = arg[1], arg[2], arg[3] or ""
local runs = math.tointeger(tonumber(arg[4] ~= "" and arg[4] or "7"))
local default_parts = "frame,reuse,jobs,many,lamps,ways,solids,programs,encode,stages,peers,readme"
local labels = {
  glint = "glint", hand = "hand-written", plain = "plain C", embree = "Embree", embree_lone = "Embree, lone",
  povray = "POV-Ray", tachyon = "Tachyon", lua = "plain Lua"
}

local function die(message)
  io.stderr:write("bench: ", message, "\n")
  os.exit(2)
end

if not runs or runs < 1 or runs > 1000 then die(("RUNS: whole number 1 .. 1000 expected, got '%s'"):format(arg[4])) end

local function parts_of(text)
  local known, parts = {}, {}
  known.stages, known.readme = true, true
  for _, row in ipairs(cases.rows) do known[row[1]] = #row > 1 or nil end
  for part in (text == "" and default_parts or text):gmatch "[^,%s]+" do
    if not known[part] then die(("BENCH: no part '%s'; there are %s, slow"):format(part, default_parts)) end
    parts[part] = true
  end
  return parts
end

-- The ids of the measurements that the rows of these parts need.
local function wanted_by(parts)
  local wanted = {}
  for _, row in ipairs(cases.rows) do
    for column = 3, parts[row[1]] and 4 or 0 do
      if row[column] then wanted[row[column]:match "^[^:]+"] = true end
    end
  end
  for _, id in ipairs(cases.stage_sides) do wanted[id] = parts.stages end
  for _, row in ipairs(parts.readme and cases.readme or {}) do
    for column = 2, 5 do
      if row[column] then wanted[row[column]:match "^[^:]+"] = true end
    end
  end
  return wanted
end

local function output_of(command)
  local pipe = assert(io.popen(command))
  local text = pipe:read "a"
  pipe:close()
  return (text:gsub("%s+$", ""))
end

local function machine()
  local model = output_of "sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1"
  local isa = output_of(build .. "/tests/bench/glint_side isa")
  return model ~= "" and model or output_of "uname -m", isa
end

-- ---- The table ----

local by_id = {}
for _, m in ipairs(cases.measurements) do by_id[m[1]] = m end

-- Returns the samples of "id:name", or nil and the reason why there are none.
local function samples_of(name)
  local id, value = name:match "^(.-):(.+)$"
  local m = assert(by_id[id], name)
  if m.refused then return nil, m.refused end
  local samples = assert(m.samples[value], name)
  return samples
end

local function number(x)
  if x >= 1000 then return ("%.0f"):format(x) end
  return ("%.3g"):format(x)
end

-- Formats the median and, in parentheses, the quartiles: median (lower .. upper).
local function cell(samples)
  if not samples then return "-" end
  local low, median, high = measure.quartiles(samples)
  if #samples == 1 then return number(median) .. " (1 run)" end
  local runs_note = #samples < 7 and (", %d runs"):format(#samples) or ""
  return ("%s (%s..%s%s)"):format(number(median), number(low), number(high), runs_note)
end

local function median(samples)
  local _, m = measure.quartiles(samples)
  return m
end

local function verdict(row, ratio)
  if not row.bar then return "" end
  local met = row.more and ratio >= row.bar or not row.more and ratio <= row.bar
  return ("%s %-5s %s"):format(row.more and ">=" or "<=", number(row.bar), met and "met" or "MISSED")
end

-- Formats a peer's other time: the processor time if the row shows the clock time, and vice versa.
local function beside(name)
  local id, value = name:match "^(.-):(.+)$"
  local samples = by_id[id].samples or {}
  if not samples.cpu then return nil end
  local other = value == "cpu" and "render" or "cpu"
  local unit = samples[other].unit == samples[value].unit and "" or " " .. samples[other].unit
  return (other == "cpu" and "processor time %s%s" or "by its clock %s%s"):format(cell(samples[other]), unit)
end

local function print_line(...) print((("%-46s %-6s %-26s %-13s %-26s %8s  %s"):format(...):gsub("%s+$", ""))) end

local function print_row(row)
  local ours, theirs, why
  if row[3] then ours, why = samples_of(row[3]) end
  local their_why
  if row[4] then theirs, their_why = samples_of(row[4]) end
  local label = row[4] and labels[by_id[row[4]:match "^[^:]+"][2]:match "%S+$"] or ""
  local unit = (ours or theirs or { unit = "" }).unit
  local note = why or their_why or row.note
  if ours and theirs then
    local ratio = row.more and median(theirs) / median(ours) or median(ours) / median(theirs)
    local last = table.concat({ verdict(row, ratio), beside(row[4]) }, "  ")
    print_line(row[2], unit, cell(ours), label, cell(theirs), ("%.2f"):format(ratio), last)
  elseif ours and not row[4] then
    print_line(row[2], unit, cell(ours), "", "", "", verdict(row, median(ours)))
  else
    local bar = row.bar and ("%s %s: "):format(row.more and ">=" or "<=", number(row.bar)) or ""
    print_line(row[2], unit, cell(ours), label, cell(theirs), "", bar .. (note or ""))
  end
end

local function print_rows(parts)
  print_line("", "unit", "glint: median (quartiles)", "beside", "median (quartiles)", "ratio", "bar")
  local heading
  for _, row in ipairs(cases.rows) do
    if #row == 1 then
      heading = row[1]
    elseif parts[row[1]] then
      if heading then print("\n" .. heading) end
      heading = nil
      print_row(row)
    end
  end
end

-- Prints a table of the nanoseconds per pixel of every stage, with one column per instruction set.
local function print_stages()
  local names, seen = {}, {}
  for _, id in ipairs(cases.stage_sides) do
    for name in pairs(by_id[id].samples) do
      if not seen[name] then names[#names + 1] = name end
      seen[name] = true
    end
  end
  table.sort(names)
  print(("\n%-20s"):format "Stages, ns a pixel" .. (" %22s"):rep(4):format("ref", "generic", "avx2", "avx512"))
  for _, name in ipairs(names) do
    local cells = {}
    for i, id in ipairs(cases.stage_sides) do
      cells[i] = by_id[id].refused and "lacking" or cell(by_id[id].samples[name])
    end
    print(("%-20s"):format(name) .. (" %22s"):rep(4):format(table.unpack(cells)))
  end
end

-- Prints the README's table: rows of Markdown, in milliseconds.
local function print_readme()
  print "\n| scene | glint, double | hand-written, float | Embree, float | POV-Ray |\n| --- | --- | --- | --- | --- |"
  for _, row in ipairs(cases.readme) do
    local cells = { row[1] }
    for column = 2, 5 do
      local samples = row[column] and samples_of(row[column])
      cells[column] = samples and " " .. number(median(samples) * (samples.unit == "s" and 1000 or 1)) or ""
    end
    print("| " .. table.concat(cells, " |") .. " |")
  end
end

local function write_csv(folder, file_name)
  os.execute(("mkdir -p '%s'"):format(folder))
  local path = folder .. "/" .. file_name
  local file = assert(io.open(path, "w"))
  file:write "name,side,unit,runs,q1,median,q3\n"
  for _, m in ipairs(cases.measurements) do
    local names = {}
    for name in pairs(m.samples) do names[#names + 1] = name end
    table.sort(names)
    for _, name in ipairs(names) do
      local s = m.samples[name]
      local title = m[3]:gsub(" out=%S+", "") .. " " .. name
      file:write(("%s,%s,%s,%d,%.6g,%.6g,%.6g\n"):format(title, m[2], s.unit, #s, measure.quartiles(s)))
    end
  end
  file:close()
  return path
end

local parts = parts_of(selection)
local model, isa = machine()
local pictures = output_of 'mktemp -d "${TMPDIR:-/tmp}/glint-bench-XXXXXX"'
local progress = os.execute "test -t 2" == true
measure.run(cases.measurements,
  { build = build, runs = runs, wanted = wanted_by(parts), folder = pictures, progress = progress })
os.execute(("rm -rf '%s'"):format(pictures))

print(("%s, %s processors; glint in %s; %s"):format(model, output_of "nproc", isa, compiler))
print(("1920x1080; %d runs where not told, all sides in every round, in random order; files in %s\n"):format(runs,
  pictures:match "^(.*)/"))
if selection ~= "readme" then print_rows(parts) end
if parts.stages then print_stages() end
if parts.readme then print_readme() end

local file = ("%s-%s.csv"):format(model:lower():gsub("%W+", "-"):gsub("^-+", ""):gsub("-+$", ""), isa)
print("\nCSV: " .. write_csv(selection == "" and "tests/bench/results" or build .. "/tests/bench", file))
