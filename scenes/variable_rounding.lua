-- One density, six filter radii: Lobb's figure 13, "from pure polyhedral modelling to soft objects".
--
-- From the back left: 0.01, 0.05, 0.1, 0.2, 0.3, 0.5. The object is obj4 of csg_examples.lua in the
-- papers' arithmetic. Its walls are 0.25 thick: from a radius of 0.125 on their planes act on each
-- other, and the Boolean density, -D form=boolean, gives another shape; visibly so from 0.2 on.

local form = param("form", "lobb")
local softness = param("softness", 1)  -- all radii times this; 0 makes everything sharp

local box1 = cube():scale(0.5):translate(0.25, 0.8, 0.25)
local box2 = cube():scale(0.5, 1, 0.5):translate(0.25, 0.8, 0.25)
local below_top = halfspace({0, 1, 0}, 1)
local density = form == "boolean" and cube() & ~box1 or cube() - below_top * box2

local solids = {
  sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.56, 0.55, 0.53} }),
}
for i, r in ipairs{0.01, 0.05, 0.1, 0.2, 0.3, 0.5} do
  local column, row = (i - 1) % 3, (i - 1) // 3
  solids[#solids + 1] = rounded(softness * r, density)
    :translate(1.8 * (column - 1) - 0.5, 0, 2.1 * (row - 0.5) - 0.5)
    :material(plastic{ color = {0.58, 0.13, 0.05}, roughness = 0.32 })
end

-- One hard light, or two soft ones as in a photographer's studio, for pictures of paths.
local lights = {
  point = { point_light{ position = {-8, 12, 5}, color = {1, 0.96, 0.9}, power = 8500 } },
  studio = { area_light{ position = {-7.4, 7, -1.5}, u = {3.4, 4, 0}, v = {0, 0, 5}, color = {1, 0.97, 0.93}, power = 1000 },
             area_light{ position = {7, 4.5, 5}, u = {-3, 0, 3}, v = {-1.5, 2.5, -1.5}, color = {1, 0.9, 0.8}, power = 300 } },
}
local skies = {
  point = sky{ horizon = {0.36, 0.40, 0.46}, zenith = {0.22, 0.28, 0.36} },
  studio = sky{ horizon = {0.42, 0.44, 0.48}, zenith = {0.34, 0.39, 0.46} },
}
local light = param("light", "point")

return {
  image = { width = 600, height = 380, spp = 1 },
  camera = { eye = {1.9, 6.4, 8.8}, target = {0.16, 0.30, 0.10}, up = {0, 1, 0}, fov = 23.5 },
  lights = lights[light] or error("light: expected point or studio, got " .. tostring(light)),
  background = skies[light],
  solids = solids,
}
