-- Four cubes that overlap a little: Lobb's figure 15 (b) on the left, where they are summed. In the
-- overlap the density is 2, and 4 in the middle, so that a seam bulges out of the faces and the
-- surface leaves its bounds; `info` tells of it, and `render` warns.
-- On the right their Boolean union, which is right for every model: no seam.

local r = param("r", 0.12)
local overlap = param("overlap", 0.06)

local function four(join)
  local all
  for _, x in ipairs{-1, 1} do
    for _, z in ipairs{-1, 1} do
      local one = box({-0.5, 0, -0.5}, {0.5, 1, 0.5}):translate(x * (0.5 - overlap / 2), 0, z * (0.5 - overlap / 2))
      all = all and join(all, one) or one
    end
  end
  return all
end

local paint = plastic{ color = {0.62, 0.15, 0.03}, roughness = 0.3 }

return {
  image = { width = 600, height = 380, spp = 1, exposure = -0.8 },
  camera = { eye = {3.4, 5.2, 7.4}, target = {0, 0.36, 0}, up = {0, 1, 0}, fov = 27 },
  lights = { area_light{ position = {-5, 8, 3}, u = {1.2, 0, 2}, v = {-1.6, -1.6, 1},
                         color = {1, 0.96, 0.9}, power = 1900 } },
  background = sky{ horizon = {0.46, 0.50, 0.56}, zenith = {0.24, 0.31, 0.40} },
  solids = {
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.56, 0.55, 0.53} }),
    rounded(r, four(function(a, b) return a + b end)):translate(-1.35, 0, 0):material(paint),
    rounded(r, four(function(a, b) return a | b end)):translate(1.35, 0, 0):material(paint),
  },
}
