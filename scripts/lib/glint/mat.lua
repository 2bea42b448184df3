-- Writes arrays as MATLAB's .mat of level 5, which SciPy also reads, without a date.
--     require("glint.mat").write("Normal_gt.mat", "Normal_gt", { height, width, 3 }, function(y, x, c) return ... end)
local mat = {}

local INT8, INT32, UINT32, DOUBLE, MATRIX = 1, 5, 6, 9, 14
local DOUBLE_CLASS = 6

-- Returns a data element: its type, its size, its bytes, padded to a multiple of eight.
local function element(kind, bytes)
  return ("<I4I4"):pack(kind, #bytes) .. bytes .. ("\0"):rep(-#bytes % 8)
end

--- Writes one array of doubles.
---@param path string
---@param name string  name of the variable
---@param size table  size of each dimension: { rows, columns, layers }
---@param value function  returns the number at a position, from 1: value(row, column, layer)
function mat.write(path, name, size, value)
  local numbers = {}
  for layer = 1, size[3] or 1 do
    for column = 1, size[2] do
      local list = {}
      for row = 1, size[1] do list[row] = ("<d"):pack(value(row, column, layer)) end
      numbers[#numbers + 1] = table.concat(list)
    end
  end
  local sizes = ("<" .. ("i4"):rep(#size)):pack(table.unpack(size))
  local matrix = element(UINT32, ("<I4I4"):pack(DOUBLE_CLASS, 0)) .. element(INT32, sizes) .. element(INT8, name)
    .. element(DOUBLE, table.concat(numbers))
  local head = "MATLAB 5.0 MAT-file, written by glint"
  local file = assert(io.open(path, "wb"))
  assert(file:write(head, (" "):rep(116 - #head), ("\0"):rep(8), ("<I2"):pack(0x0100), "IM", element(MATRIX, matrix)))
  assert(file:close())
end

return mat
