return {
  image = { width = 8, height = 6, spp = 4, bounces = 2 },
  ambient = {0.1, 0.1, 0.1},
  background = sky{ horizon = {0.8, 0.85, 0.9}, zenith = {0.3, 0.5, 0.8} },
  lights = {
    directional_light{ direction = {0, -1, 0}, color = {1, 1, 1}, power = 2 },
    area_light{ position = {0, 4, 0}, u = {1, 0, 0}, v = {0, 0, 1}, color = {1, 1, 1}, power = 9, samples = 4 },
  },
  solids = {
    rounded(0.1, cube() | ~halfspace({0, 1, 0}, 0) & box({0, 0, 0}, {2, 1, 1})):name("a"):rotate(30, {0, 0, 1})
      :material(plastic{ color = wood{ a = {0.6, 0.4, 0.2}, b = {0.3, 0.1, 0}, scale = 0.1 }, roughness = 0.3 }),
    sharp(prism({ {0, 0}, {1, 0}, {0, 1} }, 0, 1)):mirror({1, 0, 0}):material(glass{ ior = 1.5 }),
    sharp(convex{ {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1} }):material(mirror{}),
    ellipsoid{ center = {0, 0, 0}, radii = {1, 2, 1} } - cylinder{ center = {0, 0, 0}, axis = {0, 1, 0}, radius = 0.5 },
  },
}
