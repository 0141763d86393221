-- An owl of glazed clay: one free form from an ellipsoid and 83 perturbation functions, as many as the
-- model of Vyatkin's figure 14 has (it is not printed). Only the eyes are separate. Most of the 83 are
-- feathers; a ray meets few of them, and pays for no more.

local parts = {}

-- A bump (a dent where factor < 0) in the shape of an ellipsoid, turned about an axis.
local function bump(factor, center, radii, degrees, axis)
  local one = perturbation(factor, ellipsoid{ radii = radii })
    :rotate(degrees or 0, axis or {0, 0, 1}):translate(center[1], center[2], center[3])
  parts[#parts + 1] = one
  return one
end

-- The same on both sides of the plane x = 0.
local function pair(...)
  local one = bump(...)
  parts[#parts + 1] = one:mirror({1, 0, 0})
end

local body = ellipsoid{ center = {0, 0.95, 0}, radii = {0.74, 0.98, 0.66} }

bump(5, {0, 1.84, 0.06}, {0.82, 0.60, 0.70})                       -- head                          1
pair(9, {0.50, 2.22, 0.04}, {0.20, 0.36, 0.18}, -28)               -- ear tufts                     3
pair(-2.2, {0.27, 1.90, 0.60}, {0.34, 0.34, 0.34})                 -- hollows around the eyes       5
bump(10, {0, 1.78, 0.60}, {0.13, 0.26, 0.26}, 20, {1, 0, 0})       -- beak                          6
bump(3, {0, 2.12, 0.52}, {0.16, 0.30, 0.24})                       -- brow between the eyes         7
pair(3.0, {0.72, 0.92, 0.00}, {0.22, 0.72, 0.52}, 8)               -- wings                         9
pair(12, {0.62, 0.34, -0.34}, {0.20, 0.50, 0.22}, -10)             -- wing tips                    11
bump(10, {0, 0.22, -0.62}, {0.36, 0.24, 0.50}, -25, {1, 0, 0})     -- tail                         12
for toe = -1, 1 do                                                 -- toes                         18
  pair(14, {0.28 + 0.13 * toe, 0.07, 0.52 - 0.04 * toe * toe}, {0.11, 0.13, 0.30})
end

-- Feathers on the breast, in rows that are offset: 4 + 5 + 6 + 5 + 4 = 24                        42
for row, count in ipairs{4, 5, 6, 5, 4} do
  local y = 1.46 - 0.21 * (row - 1)
  for i = 1, count do
    local angle = math.rad(19) * (i - 0.5 * (count + 1))
    local r = math.sqrt(math.max(0, 1 - ((y - 0.95) / 0.98) ^ 2))
    bump(1.6, {0.74 * r * math.sin(angle), y, 0.66 * r * math.cos(angle)}, {0.13, 0.17, 0.13}, 25, {1, 0, 0})
  end
end

-- Feathers on each wing: 3 + 4 + 4 + 3 = 14 a side                                               70
for row, count in ipairs{3, 4, 4, 3} do
  local y = 1.30 - 0.25 * (row - 1)
  for i = 1, count do
    local angle = math.rad(62 + 19 * (i - 1) + 6 * (row % 2))
    pair(2.2, {0.86 * math.sin(angle), y, 0.60 * math.cos(angle)}, {0.15, 0.21, 0.15}, 8)
  end
end

-- Feathers down the back: 4 + 5 + 4 = 13                                                         83
for row, count in ipairs{4, 5, 4} do
  local y = 1.36 - 0.27 * (row - 1)
  for i = 1, count do
    local angle = math.rad(180 + 21 * (i - 0.5 * (count + 1)))
    bump(1.8, {0.72 * math.sin(angle), y, 0.64 * math.cos(angle)}, {0.15, 0.20, 0.15})
  end
end

assert(#parts == 83, "expected 83 perturbations, got " .. #parts)

local clay = plastic{ color = {0.42, 0.19, 0.07}, roughness = 0.16 }
local iris = plastic{ color = {0.80, 0.42, 0.02}, roughness = 0.12 }
local pupil = plastic{ color = {0.01, 0.01, 0.012}, roughness = 0.1 }

local oak = plastic{ color = wood{ a = {0.30, 0.165, 0.075}, b = {0.20, 0.10, 0.042}, scale = 0.35, axis = {1, 0.02, 0.1} }, roughness = 0.35 }

local eyes = {}
for _, side in ipairs{1, -1} do
  eyes[#eyes + 1] = ellipsoid{ center = {0.27 * side, 1.90, 0.46}, radius = 0.19 }:material(iris)
  eyes[#eyes + 1] = ellipsoid{ center = {0.275 * side, 1.905, 0.535}, radius = 0.13 }:material(pupil)
end

local solids = {
  freeform(body, parts):material(clay):name("owl"),
  sharp(halfspace({0, 1, 0}, 0)):material(oak):name("table"),
  sharp(halfspace({0, 0, 1}, -5)):material(matte{ color = {0.20, 0.29, 0.30} }):name("wall"),
}
for _, eye in ipairs(eyes) do solids[#solids + 1] = eye end

return {
  image = { width = 480, height = 600, spp = 16 },
  camera = { eye = {1.9, 2.5, 6.0}, target = {0, 1.18, 0}, fov = 27, lens = { radius = 0.06, focus = 5.6 } },
  lights = {
    area_light{ position = {-5, 6, 5}, u = {0, 3.4, -1.7}, v = {3.4, 0, 3.4}, color = {1, 0.95, 0.88}, power = 850, samples = 4 },
    area_light{ position = {5, 4, -2}, u = {0, 3.4, 0}, v = {1.7, 0, 3.4}, color = {0.75, 0.87, 1}, power = 220, samples = 2 },
  },
  background = sky{ horizon = {0.60, 0.60, 0.60}, zenith = {0.34, 0.36, 0.40} },
  solids = solids,
}
