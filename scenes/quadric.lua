-- Surfaces of second order, Vyatkin's figure 1. From the left: a cone and a paraboloid, an ellipsoid, a
-- cylinder, a hyperboloid of one sheet (hollow, between two) and one of two sheets. What would reach
-- to infinity is cut by half-spaces.

local function between(low, high) return sharp(halfspace({0, 1, 0}, high) * halfspace({0, -1, 0}, -low)) end

local r = 0.62
local shapes = {
  cone{ apex = {0, 1.7, 0}, radius = r, height = 1.7 } & between(0, 1.7),
  paraboloid{ apex = {0, 1.6, 0}, axis = {0, -1, 0}, radius = r, height = 1.6 } & between(0, 2),
  -- the same as ellipsoid{ center = {0, 0.9, 0}, radii = {0.62, 0.9, 0.62} }
  quadric{ xx = -1 / r^2, yy = -1 / 0.81, zz = -1 / r^2, y = 1.8 / 0.81, c = 0 },
  cylinder{ radius = 0.8 * r } & between(0, 1.5),
  (hyperboloid{ center = {0, 0.95, 0}, radius = 0.36, height = 0.72 }
    - (hyperboloid{ center = {0, 0.95, 0}, radius = 0.30, height = 0.66 } & between(0.08, 3))) & between(0, 1.75),
  hyperboloid{ center = {0, 0.85, 0}, radius = 0.22, height = 0.25, sheets = 2 } & between(0, 1.7),
}
local colors = {
  {0.66, 0.10, 0.05}, {0.70, 0.33, 0.03}, {0.62, 0.50, 0.06},
  {0.10, 0.36, 0.14}, {0.04, 0.24, 0.48}, {0.28, 0.09, 0.36},
}

local solids = { sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.54, 0.53, 0.51} }):name("floor") }
for i, shape in ipairs(shapes) do
  local column, row = (i - 1) % 3, (i - 1) // 3
  solids[#solids + 1] = shape:translate(1.75 * (column - 1) + 0.35 * row, 0, 1.8 * (row - 0.5))
    :material(plastic{ color = colors[i], roughness = 0.18 })
end

return {
  image = { width = 640, height = 440, spp = 16 },
  camera = { eye = {1.4, 4.4, 8.6}, target = {0.12, 0.72, 0.1}, fov = 28 },
  lights = {
    area_light{ position = {-7, 7.5, 0}, u = {3.4, 4, 0}, v = {0, 0, 5}, color = {1, 0.97, 0.93}, power = 1000, samples = 4 },
    area_light{ position = {7, 5, 6}, u = {-3, 0, 3}, v = {-1.5, 2.5, -1.5}, color = {1, 0.9, 0.8}, power = 260 },
  },
  background = sky{ horizon = {0.42, 0.44, 0.48}, zenith = {0.34, 0.39, 0.46} },
  solids = solids,
}
