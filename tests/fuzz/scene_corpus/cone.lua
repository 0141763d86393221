-- A cone with a base: the object of Vyatkin's figures 10 and 11, where a mesh that relaxes its "hard"
-- edges loses the rim. The quadric is a double cone; two half-spaces leave one of its halves.

local paint = plastic{ color = {0.72, 0.30, 0.06}, roughness = 0.25 }
local one = cone{ apex = {0, 2, 0}, radius = 0.9, height = 2 }
  & sharp(halfspace({0, 1, 0}, 2) * halfspace({0, -1, 0}, 0))

return {
  image = { width = 600, height = 480, spp = 16 },
  camera = { eye = {2.4, 2.6, 5.2}, target = {0, 0.86, 0}, fov = 28 },
  lights = {
    area_light{ position = {-4, 6, 4}, u = {0, 2.5, -1.7}, v = {2.5, 0, 2.5}, color = {1, 0.96, 0.9}, power = 600, samples = 4 },
  },
  background = sky{ horizon = {0.72, 0.76, 0.80}, zenith = {0.32, 0.42, 0.56} },
  solids = {
    one:material(paint):name("cone"),
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.52, 0.52, 0.50} }):name("floor"),
  },
}
