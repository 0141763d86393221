-- What rounding does at different stages of modelling: the six objects of Lobb's figures 11 and 12.
--
-- From the back left: everything sharp; only the cube rounded; only the pit rounded; cube and pit
-- rounded as one density; a union of two rounded boxes; their rounded sum, which flows together.
--
-- Printed differently: figure 11 writes obj3 as a product of a plane and a solid, and obj4 with a
-- subtrahend that sticks out of the cube. Here obj3 is what is meant (a sharp difference needs no
-- clip), and obj4 has the clip.

local r = param("r", 0.07)

local box1 = cube():scale(0.5):translate(0.25, 0.8, 0.25)
local box2 = cube():scale(0.5, 1, 0.5):translate(0.25, 0.8, 0.25)
local box3 = cube():scale(0.5):translate(0.25, 1, 0.25)
local below_top = halfspace({0, 1, 0}, 1)

local objects = {
  sharp(cube()) - sharp(box1),
  rounded(r, cube()) - sharp(box1),
  sharp(cube()) - rounded(r, box2),
  rounded(r, cube() - below_top * box2),
  rounded(r, cube()) | rounded(r, box3),
  rounded(r, cube() + box3),
}

local paints = {
  {0.56, 0.045, 0.035}, {0.70, 0.19, 0.025}, {0.72, 0.42, 0.03},
  {0.10, 0.30, 0.07}, {0.03, 0.19, 0.42}, {0.20, 0.06, 0.30},
}

local solids = {
  sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.56, 0.55, 0.53} }),
}
for i, object in ipairs(objects) do
  local column, row = (i - 1) % 3, (i - 1) // 3
  solids[#solids + 1] = object
    :translate(1.8 * (column - 1) - 0.5, 0, 2.1 * (row - 0.5) - 0.5)
    :material(plastic{ color = paints[i], roughness = 0.32 })
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
  camera = { eye = {1.9, 6.4, 8.8}, target = {0.16, 0.40, 0.10}, up = {0, 1, 0}, fov = 23.5 },
  lights = lights[light] or error("light: expected point or studio, got " .. tostring(light)),
  background = skies[light],
  solids = solids,
}
