-- A ball bearing, cut open: two rings with grooves, balls, and a cage; spheres, cylinders and tori as densities.
local r = param("r", 0.06)

local function about(radius, low, high) return cylinder{ from = {0, low, 0}, to = {0, high, 0}, radius = radius } end
local pitch, ball = 2.5, 0.52
local groove = torus{ radius = pitch, tube = 0.56 }

local outer = about(3.4, -0.75, 0.75) & ~about(2.86, -2, 2) & ~groove
local inner = about(2.14, -0.75, 0.75) & ~about(1.5, -2, 2) & ~groove
local cage = about(2.62, -0.3, 0.3) & ~about(2.38, -2, 2)

local count = 11
local balls = {}
for i = 1, count do
  local a = 2 * math.pi * (i + 0.5) / count
  local at = { pitch * math.cos(a), 0, pitch * math.sin(a) }
  balls[i] = sphere{ center = at, radius = ball }
  cage = cage & ~sphere{ center = at, radius = ball + 0.06 }
end

-- A quarter of the outer ring is away, so that one sees in.
local away = box({0, -2, 0}, {9, 2, 9})
local steel = metal{ color = {0.62, 0.63, 0.65}, roughness = 0.18 }
local brass = metal{ color = {0.83, 0.58, 0.25}, roughness = 0.22 }
local chrome = metal{ color = {0.75, 0.75, 0.77}, roughness = 0.05 }
local solids = { rounded(r, outer & ~away):material(steel), rounded(r, inner):material(steel),
                 rounded(0.03, cage):material(brass) }
for _, b in ipairs(balls) do solids[#solids + 1] = rounded(r, b):material(chrome) end
for i, solid in ipairs(solids) do solids[i] = solid:rotate(28, {0, 1, 0}):translate(0, 0.75, 0) end
solids[#solids + 1] = sharp(halfspace({0, 1, 0}, 0)):material(plastic{ color = {0.10,0.105,0.115}, roughness = 0.32 })

return {
  image = { width = 720, height = 456 },
  camera = { eye = {2.4, 8.4, 12.6}, target = {0.35, 0.35, 0.25}, fov = 26.5, lens = { radius = 0.1, focus = 13.4 } },
  lights = { area_light{ position = {-8, 9, -2}, u = {5, 5, 0}, v = {0, 0, 7}, power = 900, color = {1, 0.97, 0.93} },
             area_light{ position = {8, 5, 7}, u = {-4, 0, 4}, v = {-2, 3, -2}, power = 330, color = {1, 0.9, 0.8} },
             area_light{ position = {0, 7, -11}, u = {9, 0, 0}, v = {0, 3, 3}, power = 700, color = {0.88, 0.94, 1} },
             area_light{ position = {-6, 3.5, 11}, u = {0, 4, 0}, v = {6, 0, 4}, power = 300 } },
  background = sky{ horizon = {0.14, 0.145, 0.16}, zenith = {0.26, 0.29, 0.34} },
  solids = solids,
}
