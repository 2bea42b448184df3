DATA = {}
for x, y in string.gfind("2,0 -2,0.5 0,2 0.5,-2", "([-%d.]+),([-%d.]+)") do
  DATA[table.getn(DATA) + 1] = {x, y, math.mod(x * 7, 3) - 1}
end
