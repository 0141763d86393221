-- A bored and chamfered block with four pins: sides = 0: round parts; 4, 40: prisms of as many sides.
local sides = param("sides", 0)

local function pin(x, z, y0, y1, r)
  if sides == 0 then return cylinder{ from = {x, y0, z}, to = {x, y1, z}, radius = r } end
  local p = {}
  for i = 0, sides - 1 do
    local a = 2 * math.pi * (i + 0.5) / sides
    p[i + 1] = {r / math.cos(math.pi / sides) * math.cos(a), r / math.cos(math.pi / sides) * math.sin(a)}
  end
  return prism(p, y0, y1, { axis = "y" }):translate(x, 0, z)
end

local d = box({-2, 0, -1}, {2, 1, 1}) & halfspace({1, 1, 0}, 2.7) & halfspace({-1, 1, 0}, 2.7)
    & halfspace({0, 1, 1}, 1.7) & halfspace({0, 1, -1}, 1.7) & ~pin(0, 0, -1, 2, 0.5)
for i = -1, 1, 2 do for k = -1, 1, 2 do d = d | pin(1.1 * i, 0.5 * k, 0.5, 1.8, 0.22) end end

return {
  image = { width = 800, height = 600 },
  camera = { eye = {3, 4, 5}, target = {0, 0.6, 0}, fov = 38 },
  lights = { point_light{ position = {5, 8, 6}, power = 400 } },
  background = {0.2, 0.2, 0.2},
  solids = { rounded(0.1, d) },
}
