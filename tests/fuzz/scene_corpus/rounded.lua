-- A cube with a square hole from the top, rounded as one density, on the ground.
local r = param("r", 0.1)

local hole = cube():scale(0.5, 1, 0.5):translate(0.25, 0.8, 0.25)
local top = halfspace({0, 1, 0}, 1) -- a subtrahend must not stick out of what it is taken from

return {
  image = { width = 600, height = 380 },
  camera = { eye = {3, 2.5, 4}, target = {0.5, 0.5, 0.5}, up = {0, 1, 0}, fov = 30 },
  lights = { point_light{ position = {4, 6, 3}, color = {1, 1, 1}, power = 400 } },
  background = {0.6, 0.7, 0.8},
  solids = {
    rounded(r, cube() - top * hole):material(plastic{ color = {0.8, 0.3, 0.2} }),
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.6, 0.6, 0.6} }),
  },
}
