-- Reflection models as shaders: each returns the light reflected from one lamp, the diffuse and the specular part.
--     local models = require "glint.models"
--     glint.material { diffuse = 0.6, specular = 0.4, model = models.ward { along = 0.1, across = 0.4 } }
-- As in the built-in models, a matt surface shows kd under a light of strength 1 along the normal: a BRDF f from the
-- literature becomes pi f (n.l). The engine adds shadows and ambient light.
local glint = require "glint"

local models = {}

--- B. T. Phong, "Illumination for Computer Generated Pictures", CACM 18(6), 1975: (r.v)^s, r = 2 (n.l) n - l.
function models.phong()
  return glint.shader(function(s)
    local r = (-s.l):reflect(s.n)
    return s.kd * s.light * s.n:dot(s.l), s.ks * s.light * glint.highlight(r:dot(s.v), s.shininess)
  end)
end

--- J. F. Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977: (n.h)^s,
--- h = (l + v)/|l + v|.
function models.blinn_phong()
  return glint.shader(function(s)
    local h = (s.l + s.v):unit()
    return s.kd * s.light * s.n:dot(s.l), s.ks * s.light * glint.highlight(s.n:dot(h), s.shininess)
  end)
end

--- M. Oren and S. K. Nayar, "Generalization of Lambert's Reflectance Model", SIGGRAPH 1994, their qualitative model: A
--- + B max(0, cos(phi)) sin(alpha) tan(beta), for matt surfaces with facets whose slopes have a deviation of
--- `roughness` radians. Clay and the moon look flat towards their edges.
function models.oren_nayar(options)
  local variance = (options and options.roughness or 0.5) ^ 2
  local a, b = 1 - 0.5 * variance / (variance + 0.33), 0.45 * variance / (variance + 0.09)
  return glint.shader(function(s)
    local nl, nv = s.n:dot(s.l), s.n:dot(s.v)
    local across = glint.max(0, s.l:dot(s.v) - nl * nv) -- cos(phi) sin sin
    return s.kd * s.light * nl * (a + b * across / glint.max(nl, nv))
  end)
end

--- G. J. Ward, "Measuring and Modeling Anisotropic Reflection", SIGGRAPH 1992: a Gaussian of slopes, `along` and
--- `across` brushed lines that run around the axis:
--- exp(-tan^2(delta) (cos^2/along^2 + sin^2/across^2)) / (4 pi along across sqrt((n.l) (n.v))).
function models.ward(options)
  local along, across = options and options.along or 0.15, options and options.across or 0.5
  local axis = options and options.axis or { 0, 1, 0 }
  return glint.shader(function(s)
    local nl, nv = s.n:dot(s.l), glint.max(s.n:dot(s.v), 1e-6)
    local t = glint.cross(axis, s.n):unit()
    local h = (s.l + s.v):unit()
    local x, y, z = h:dot(t) / across, h:dot(s.n:cross(t)) / along, h:dot(s.n)
    local lobe = glint.exp2(-1.4426950408889634 * (x * x + y * y) / (z * z))
    return s.kd * s.light * nl, s.ks * s.light * glint.sqrt(nl / nv) * lobe / (4 * along * across)
  end)
end

--- Bands of light as in cartoons: A. Lake et al., "Stylized Rendering Techniques for Scalable Real-Time 3D Animation",
--- NPAR 2000. `edge` is the softness of the bands' edges.
function models.toon(options)
  local edge = options and options.edge or 0.01
  local function band(x, from) return glint.smoothstep(from - edge, from + edge, x) end
  return glint.shader(function(s)
    local nl = s.n:dot(s.l)
    local r = (-s.l):reflect(s.n)
    local light = 0.25 + 0.35 * band(nl, 0.25) + 0.4 * band(nl, 0.65)
    return s.kd * s.light * light, s.ks * s.light * band(glint.highlight(r:dot(s.v), s.shininess), 0.4)
  end)
end

--- A. Gooch et al., "A Non-Photorealistic Lighting Model for Automatic Technical Illustration", SIGGRAPH 1998: from
--- cool to warm tones, here by n.l. The cool tone, kd/4 + cool, is the material's ambient light; it blends into the
--- warm one, kd/2 + warm. No component of `warm` may be below that of `cool`.
function models.gooch(options)
  local cool, warm = options and options.cool or { 0, 0, 0.25 }, options and options.warm or { 0.4, 0.4, 0.25 }
  return glint.shader(function(s)
    local more = 0.25 * s.kd + glint.sub(warm, cool)
    local r = (-s.l):reflect(s.n)
    return more * s.light * s.n:dot(s.l), s.ks * s.light * glint.highlight(r:dot(s.v), s.shininess)
  end)
end

return models
