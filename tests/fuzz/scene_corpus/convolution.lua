-- One star, rounded with one radius by quasi-convolution (left) and by true convolution, which it
-- approximates (right). They differ most at the acute tips.
local r = param("r", 0.21)

local function at(k, radius)  -- corner k of ten
  local a = math.rad(90 + 36 * k)
  return { radius * math.cos(a), radius * math.sin(a) }
end

local inner = 0.56
local core = {}
for k = 1, 9, 2 do core[#core + 1] = at(k, inner) end
local star = prism(core, 0, 0.62)
for k = 0, 8, 2 do
  star = star | prism({ at(k - 1, inner), at(k, 1.5), at(k + 1, inner) }, 0, 0.62)
end
local bore = {}
for k = 1, 9, 2 do bore[#bore + 1] = at(k, 0.34) end
star = star & ~prism(bore, 0.22, 2)

local function show(make, x, color)
  return make(r, star):rotate(14, {0, 1, 0}):translate(x, 0, 0)
    :material(plastic{ color = color, roughness = 0.08 })
end

return {
  image = { width = 720, height = 400, spp = 4 },
  camera = { eye = {0.2, 5.0, 5.6}, target = {0, 0.05, 0.12}, fov = 28 },
  lights = {
    area_light{ position = {-5, 9, 3}, u = {2.4, 0, 2.4}, v = {-2, 2.2, 2}, color = {1, 0.96, 0.9}, power = 1500 },
  },
  background = sky{ horizon = {0.44, 0.47, 0.52}, zenith = {0.20, 0.25, 0.33} },
  solids = {
    show(rounded, -1.55, {0.62, 0.10, 0.03}),
    show(convolved, 1.55, {0.03, 0.16, 0.42}),
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.62, 0.58, 0.52} }),
  },
}
