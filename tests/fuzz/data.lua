-- Reads the input as a data file; its first byte selects the reader. The reader returns data, or an error that names
-- file and line. Rows read in bulk are those read one by one. An error of Lua itself (a nil indexed, a nil added to) is a finding.
package.path = "scripts/lib/?.lua;" .. package.path
local path = ("/dev/shm/glint-fuzz-data-%d"):format(io.open("/proc/self/stat"):read "n")

local function walk(frames)
  return function()
    for frame in frames(path) do
      for _ in frame:atoms() do end
    end
  end
end

-- Reads the columns of all frames by name, then the frames again in another order.
local function run(reader)
  return function()
    local film = reader.film(path)
    for n = film:length(), 1, -2 do
      local frame = film:frame(n)
      for _ in frame:atoms(table.unpack(frame.columns, 1, 30)) do end
    end
  end
end

local function same(a, b) return a == b or a ~= a and b ~= b end

-- Returns the first frame's atoms as lists, read one by one: { x, y, z, radius, label }.
local function one_by_one(frame)
  local list = {}
  for label, x, y, z, radius in frame:atoms() do list[#list + 1] = { x + 0.0, y + 0.0, z + 0.0, radius and radius + 0.0, label } end
  return list
end

-- Reads the first frame one by one and in bulk: both give the same atoms, or the same error.
local function bulk(open)
  return function()
    local good, list = pcall(function() return one_by_one(open(path)) end)
    local done, all = pcall(function() return open(path):arrays() end)
    assert(good == done, "attempt to differ")
    if not good then
      assert(list == all, ("attempt to differ: %s, %s"):format(list, all))
      error(list, 0)
    end
    assert(#all.positions == #list, "attempt to differ in number")
    for i, atom in ipairs(list) do
      for c = 1, 3 do assert(same(all.positions[i][c], atom[c]), "attempt to differ in a position") end
      assert(all.labels[all.kinds[i]] == atom[5], "attempt to differ in a label")
      assert(not all.radii or same(all.radii[i], atom[4]), "attempt to differ in a radius")
    end
  end
end

local function load(name) return require("glint." .. name) end

-- Makes spheres and bonds of the first frame.
local function build(open)
  return function()
    local set = load "particles".new { scale = 0.5, radius = 1 }
    set:add_frame(open(path))
    if set.count > 1000 then return end
    load "bonds".new(set, { distance = 1.5 })
    set:spheres()
  end
end

local readers = {
  walk(load "xyz".frames),
  walk(load "pdb".frames),
  walk(load "lammps".frames),
  function() for _ in load "points".frame(path):atoms() do end end,
  function() load "nff".load(path) end,
  run(load "xyz"),
  run(load "pdb"),
  run(load "lammps"),
  bulk(load "xyz".frame),
  bulk(load "lammps".frame),
  bulk(load "points".frame),
  bulk(load "pdb".frame),
  build(load "xyz".frame),
  build(load "lammps".frame),
  build(load "points".frame),
  build(load "pdb".frame),
}

return function(bytes)
  if #bytes < 1 then return end
  local file = assert(io.open(path, "wb"))
  file:write(bytes:sub(2))
  file:close()
  local ok, message = pcall(readers[bytes:byte() % #readers + 1])
  os.remove(path)
  if ok then return end
  assert(type(message) == "string", "an error that is no text")
  message = message:gsub("^%S+%.lua:%d+: ", "") -- the rest of the message may quote the file
  for _, own in ipairs { "attempt to", "bad argument", "stack overflow", "malformed", "number has no" } do
    assert(message:find(own, 1, true) ~= 1, message)
  end
end
