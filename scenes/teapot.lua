-- A teapot from 13 perturbation functions, after Vyatkin's figure 16 (his coefficients are not
-- printed). Body, spout and handle are one free form, so that they flow into each other; the lid is
-- another. The handle is a disc with a hole: a bump and, within it, a dent.

-- A bump (a dent where factor < 0) in the shape of an ellipsoid, turned about the z axis.
local function bump(factor, center, radii, degrees)
  return perturbation(factor, ellipsoid{ radii = radii }):rotate(degrees or 0, {0, 0, 1})
    :translate(center[1], center[2], center[3])
end

local body = freeform(ellipsoid{ center = {0, 0.92, 0}, radii = {1.08, 0.80, 1.08} }, {
  bump(1.2, {0, 0.06, 0}, {0.92, 0.34, 0.92}),       -- foot
  bump(2.5, {0, 1.62, 0}, {0.84, 0.34, 0.84}),       -- collar under the lid
  bump(0.30, {0, 0.72, 0}, {1.60, 0.60, 1.60}),      -- belly
  bump(3, {1.05, 0.68, 0}, {0.70, 0.46, 0.40}, 25),  -- the spout's root,
  bump(9, {1.45, 1.00, 0}, {0.62, 0.33, 0.32}, 48),  -- its neck,
  bump(20, {1.74, 1.42, 0}, {0.50, 0.24, 0.25}, 62), -- its tip
  bump(14, {1.90, 1.66, 0}, {0.30, 0.20, 0.26}, 20), -- and its lip
  bump(40, {-1.30, 1.00, 0}, {0.84, 0.80, 0.22}),    -- the handle,
  bump(-160, {-1.36, 1.02, 0}, {0.56, 0.54, 0.60}),  -- the hole in it,
  bump(14, {-1.55, 1.60, 0}, {0.28, 0.15, 0.20}, 25), -- and a rest for the thumb
})

local lid = freeform(ellipsoid{ center = {0, 1.72, 0}, radii = {0.60, 0.26, 0.60} }, {
  bump(0.8, {0, 1.72, 0}, {0.86, 0.10, 0.86}),       -- rim
  bump(4, {0, 2.00, 0}, {0.22, 0.20, 0.22}),         -- stem
  bump(16, {0, 2.17, 0}, {0.26, 0.21, 0.26}),        -- knob
})

local throat = ellipsoid{ radii = {0.5, 0.085, 0.11} }:rotate(56, {0, 0, 1}):translate(2.04, 1.86, 0)
local glaze = plastic{ color = {0.10, 0.28, 0.33}, roughness = 0.12 }

return {
  image = { width = 720, height = 480, spp = 16 },
  camera = { eye = {2.6, 3.4, 7.4}, target = {0.16, 1.02, 0}, fov = 26 },
  lights = {
    area_light{ position = {-6, 6, 5}, u = {0, 5.1, -3.4}, v = {5.1, 0, 5.1}, color = {1, 0.95, 0.88}, power = 880, samples = 4 },
    area_light{ position = {5, 5, -4}, u = {0, 3.4, 0}, v = {3.4, 0, 3.4}, color = {0.8, 0.9, 1}, power = 360, samples = 2 },
  },
  background = sky{ horizon = {0.75, 0.78, 0.80}, zenith = {0.30, 0.38, 0.50} },
  solids = {
    ((body - throat) | lid):material(glaze):name("teapot"),
    sharp(halfspace({0, 1, 0}, 0.02)):material(matte{ color = {0.50, 0.46, 0.42} }):name("table"),
  },
}
