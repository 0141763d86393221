-- A free form from an ellipsoid and three perturbations, after Vyatkin's figure 2: two bumps and a
-- dent, which flow into the ellipsoid without an edge.

local f = param("f", 1)  -- 0 is the ellipsoid alone

local stone = freeform(ellipsoid{ center = {0, 1, 0}, radii = {1.15, 0.95, 0.95} }, {
  perturbation(2.2 * f, ellipsoid{ center = {0.75, 1.75, 0.1}, radii = {0.95, 0.80, 0.85} }),
  perturbation(1.6 * f, ellipsoid{ center = {-1.05, 0.75, 0.25}, radii = {0.90, 0.70, 0.75} }),
  perturbation(-3.0 * f, ellipsoid{ center = {-0.10, 1.35, 0.85}, radii = {0.62, 0.55, 0.70} }),
})

return {
  image = { width = 600, height = 450, spp = 16 },
  camera = { eye = {1.2, 2.9, 6.2}, target = {0, 0.98, 0}, fov = 31 },
  lights = {
    area_light{ position = {-5, 6, 4}, u = {0, 3.4, -1.7}, v = {3.4, 0, 3.4}, color = {1, 0.95, 0.88}, power = 680, samples = 4 },
    area_light{ position = {5, 3, -3}, u = {0, 1.7, 0}, v = {1.7, 0, 1.7}, color = {0.7, 0.85, 1}, power = 190, samples = 2 },
  },
  background = sky{ horizon = {0.74, 0.76, 0.78}, zenith = {0.34, 0.42, 0.54} },
  solids = {
    stone:material(plastic{ color = {0.58, 0.08, 0.06}, roughness = 0.15 }):name("stone"),
    sharp(halfspace({0, 1, 0}, 0.06)):material(matte{ color = {0.54, 0.52, 0.50} }):name("table"),
  },
}
