-- circles.lua OBJECT...: checks who calls whom in the engine and in the binding, by symbols. Fails if more than 4 files
-- call each other in a circle, or if a part calls one that it must not know. The table of effects (render/effects/list.c) names all stages
-- so that no other file needs to; its references do not count.
local MOST <const> = 4

-- The parts that each part may call; "public": only what the public headers declare.
local KNOWS <const> = {
    base = {},
    film = { base = true },
    render = { base = true, film = true },
    figures = { base = true, film = true, render = "public" },
    files = { base = true, film = true, render = "public", figures = true },
    compare = { base = true, film = true, render = "public", files = true },
    ["bindings/value"] = {},
    ["bindings/pattern"] = { ["bindings/value"] = true },
    ["bindings/run"] = { ["bindings/value"] = true, ["bindings/pattern"] = true, ["bindings/lua"] = true },
    ["bindings/lua"] = { ["bindings/value"] = true, ["bindings/pattern"] = true, ["bindings/run"] = true },
}
-- The commands know all of the binding.

-- Returns the part of a file: "render", "bindings/value".
local function part_of(file)
    return file:match("^bindings/[^/]+") or file:match("^[^/]+")
end

-- Returns how a part knows another one: true, "public" or nil.
local function knows(part, other)
    if part == other or part:find("^bindings/") and not KNOWS[part] and other:find("^bindings/") then
        return true
    end
    return KNOWS[part] and KNOWS[part][other] or part:find("^bindings/") and not other:find("^bindings/") and "public"
end

local definer, wanted, files = {}, {}, {}
for _, object in ipairs(arg) do
    local name = object:match("engine/(.*)%.o$") or object:match("(bindings/.*)%.o$")
    if name and name ~= "render/effects/list" and not name:find("^render/stages/") and not name:find("/kernel[^/]*$") then
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
assert(#files > 0, "objects expected")

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

-- Effects call the core and paths/. Whom they call beyond that stands in their declarations.
local MOST_CALLS <const> = 9

-- Returns the effects that an effect says it calls.
local function calls(effect)
    local list <close> = assert(io.popen(("grep -ho '\\.calls = \".*\"' engine/render/effects/%s/*.c"):format(effect)))
    return (list:read("a"):match('"(.*)"'))
end

local public = {}
for _, header in ipairs { "", "_compare", "_data", "_figures", "_files", "_inspect", "_math", "_programs" } do
    for line in io.lines("engine/glint" .. header .. ".h") do
        for symbol in line:gmatch("glint_[%w_]+") do
            public[symbol] = true
        end
    end
end

local reached, bad, done, called, whole = {}, false, {}, {}, true
for _, file in ipairs(files) do
    local part = part_of(file)
    for symbol in pairs(wanted[file]) do
        local other = definer[symbol]
        local whose = other and part_of(other)
        local known = whose and knows(part, whose)
        local effect, callee = file:match("^render/effects/([^/]+)/"), other and other:match("^render/effects/([^/]+)/")
        if callee and effect ~= callee and part == "render" then
            called[(effect or file) .. " " .. callee] = symbol
        end
        if whose and not (known == true or known == "public" and public[symbol]) then
            print(("%s calls %s of %s, which %s does not know"):format(file, symbol, other, part))
            bad = true
        end
    end
end
for _, file in ipairs(files) do
    whole = whole and not file:find("left_out$")
end
local count = 0
for name in assert(io.popen("ls -d engine/render/effects/*/ | xargs -n1 basename")):lines() do
    for callee in (calls(name) or ""):gmatch("%S+") do
        local edge = name .. " " .. callee
        if whole and not called[edge] then
            print(edge .. ": the effect no longer calls the other; take it out of its declaration")
            bad = true
        end
        called[edge] = nil
        count = count + 1
    end
end
if count > MOST_CALLS then
    print(("effects call each other along %d edges, at most %d expected"):format(count, MOST_CALLS))
    bad = true
end
for edge, symbol in pairs(called) do
    print(edge .. ": only effects call effects, and say so in their declarations: " .. symbol)
    bad = true
end

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
        print(("%d files call each other in a circle, at most %d expected:"):format(#circle, MOST))
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
