-- A radius for each half-space: Lobb's figure 15 (a), as extreme as there. The block of unit height
-- is the intersection of four planes with a radius of 0.3 and two, its ends, with 0.03.
--
-- The rounds on the ends are no circles but nearly ellipses with half axes of 0.3 and 0.03: the
-- radius belongs to the plane, not to the edge.

local soft, crisp = param("soft", 0.3), param("crisp", 0.03)

local around = halfspace({0, 1, 0}, 1) * halfspace({0, -1, 0}, 0)
             * halfspace({0, 0, 1}, 0.7) * halfspace({0, 0, -1}, 0.7)
local ends = halfspace({1, 0, 0}, 1.1) * halfspace({-1, 0, 0}, 1.1)
local block = around:radius(soft) * ends:radius(crisp)

return {
  image = { width = 600, height = 380, spp = 1 },
  camera = { eye = {4.3, 3.1, 4.4}, target = {0.05, 0.42, 0}, up = {0, 1, 0}, fov = 26 },
  lights = { area_light{ position = {-4, 9, 6}, u = {1.5, 0, 1}, v = {-1, -1.3, 1.5},
                         color = {1, 0.96, 0.9}, power = 1800 } },
  background = sky{ horizon = {0.46, 0.50, 0.56}, zenith = {0.24, 0.31, 0.40} },
  solids = {
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.56, 0.55, 0.53} }),
    rounded(0, block):material(plastic{ color = {0.03, 0.19, 0.42}, roughness = 0.3 }),
  },
}
