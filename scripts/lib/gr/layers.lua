-- Layers on shapes that only few variants have: normal maps, and noise.
local check = require "gr.check"
local normal_map = require "gr.normal_map"
local surface = require "gr.surface"
check.own_source()

local pairs, setmetatable, type = pairs, setmetatable, type

--- Adds the calls to gr. shape_of(call, node): the data of a shape; methods: the metatable of the objects made here.
return function(gr, shape_of, methods)
  local maps, grains = setmetatable({}, { __mode = "k" }), setmetatable({}, { __mode = "k" })

  function gr.normal_map(file, ...)
    local object = setmetatable({}, methods "normal map")
    maps[object] = surface.normals("normal_map", file, ...)
    check.name_object(object, "normal map")
    return object
  end

  for _, call in pairs { "set_normal", "set_normal_map" } do
    gr[call] = function(self, map, ...)
      local node = shape_of(call, self)
      if not maps[map] and type(map) ~= "string" then
        check.refuse(call, "map", "normal map or name of a file", map)
      end
      if not normal_map.lies_on(node) then
        return check.tell(node, "gr.%s: spheres, boxes, cylinders and cones have normal maps, and %s '%s' has none",
          call, node.call, node.name)
      end
      node.normals = maps[map] or surface.normals(call, map, ...)
    end
  end

  function gr.perlin()
    local object = setmetatable({}, methods "perlin")
    grains[object] = true
    check.name_object(object, "perlin")
    return object
  end

  -- Each variant uses its own kinds of noise.
  function gr.set_perlin(self, kind)
    local node = shape_of("set_perlin", self)
    if not grains[kind] then check.number("set_perlin", "kind", kind) end
    check.tell("set_perlin", "gr.set_perlin: glint uses its own noise")
    node.grain = grains
  end
end
