-- circles.lua OBJECT...: fails if more than 4 files of the engine call each other in a circle, judged by their symbols.
-- The table of effects (effects/list.c) names all stages so that no other file needs to; its references do not count.
local MOST <const> = 4

local definer, wanted, files = {}, {}, {}
for _, object in ipairs(arg) do
    local name = object:match("engine/(.*)%.o$")
    if name and name ~= "effects/list" and not name:find("^stages/") and not name:find("/kernel[^/]*$") then
        files[#files + 1] = name
        wanted[name] = {}
        local list <close> = assert(io.popen(("nm -g '%s'"):format(object)))
        for line in list:lines() do
            local kind, symbol = line:match("(%a) (%S+)$")
            if kind == "U" then
                wanted[name][symbol] = true
            elseif kind then
                definer[symbol] = name
            end
        end
    end
end
assert(#files > 0, "objects of the engine expected")

-- Returns, for each file, the files that it calls directly or indirectly.
local function reach(from)
    local found, left = {}, { from }
    while #left > 0 do
        for symbol in pairs(wanted[table.remove(left)]) do
            local file = definer[symbol]
            if file and not found[file] then
                found[file] = true
                left[#left + 1] = file
            end
        end
    end
    return found
end

local reached, bad, done = {}, false, {}
for _, file in ipairs(files) do
    reached[file] = reach(file)
end
for _, file in ipairs(files) do
    local circle = {}
    for other in pairs(reached[file]) do
        if reached[other][file] and not done[other] then
            circle[#circle + 1] = other
        end
    end
    for _, other in ipairs(circle) do
        done[other] = true
    end
    if #circle > MOST then
        table.sort(circle)
        print(("%d files of the engine call each other in a circle, at most %d expected:"):format(#circle, MOST))
        for _, one in ipairs(circle) do
            for symbol in pairs(wanted[one]) do
                local other = definer[symbol]
                if other and other ~= one and reached[other][one] then
                    print(("  %s -> %s: %s"):format(one, other, symbol))
                end
            end
        end
        bad = true
    end
end
os.exit(not bad)
