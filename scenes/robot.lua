-- A robot that is smoothed by one radius throughout: Triage's section 6.4, where a growing filter
-- makes it vanish. One Boolean density, so every radius is legal; -D r=0.5 and more melt it.

local r = param("r", 0.08)

local function pair(part) return part | part:mirror({1, 0, 0}) end

local foot = box({0.18, 0, -0.42}, {0.86, 0.30, 0.78})
local shin = box({0.30, 0.26, -0.22}, {0.76, 1.10, 0.28})
local knee = box({0.24, 1.00, -0.28}, {0.82, 1.30, 0.36})
local thigh = box({0.32, 1.22, -0.20}, {0.74, 2.00, 0.26})
local hips = box({-0.82, 1.86, -0.36}, {0.82, 2.30, 0.40})
local belly = box({-0.52, 2.20, -0.28}, {0.52, 2.62, 0.32})
local chest = convex{ {-0.86, 2.55, -0.42}, {0.86, 2.55, -0.42}, {-0.86, 2.55, 0.46}, {0.86, 2.55, 0.46},
                      {-1.12, 3.80, -0.50}, {1.12, 3.80, -0.50}, {-1.12, 3.80, 0.54}, {1.12, 3.80, 0.54} }
local panel = box({-0.55, 2.95, 0.40}, {0.55, 3.55, 0.66})
local neck = box({-0.26, 3.70, -0.20}, {0.26, 4.10, 0.24})
local head = box({-0.62, 4.00, -0.50}, {0.62, 4.92, 0.54})
local eye = box({0.14, 4.44, 0.40}, {0.42, 4.68, 0.80})
local mouth = box({-0.34, 4.12, 0.44}, {0.34, 4.24, 0.80})
local ear = box({0.56, 4.28, -0.14}, {0.80, 4.66, 0.20})
local antenna = box({-0.07, 4.86, -0.07}, {0.07, 5.42, 0.07}) | box({-0.17, 5.30, -0.17}, {0.17, 5.60, 0.17})
local shoulder = box({1.02, 3.30, -0.32}, {1.62, 3.86, 0.36})
local upper_arm = box({1.14, 2.62, -0.20}, {1.54, 3.40, 0.24})
local fore_arm = box({-0.22, -1.02, -0.24}, {0.22, 0.12, 0.24}):rotate(-58, {1, 0, 0}):translate(1.34, 2.66, 0.04)
local hand = box({-0.30, -1.42, -0.30}, {0.30, -0.92, 0.30}):rotate(-58, {1, 0, 0}):translate(1.34, 2.66, 0.04)
local claw = box({-0.12, -1.8, -0.42}, {0.12, -1.12, 0.42}):rotate(-58, {1, 0, 0}):translate(1.34, 2.66, 0.04)

local robot = pair(foot | shin | knee | thigh | shoulder | upper_arm | fore_arm | (hand & ~claw) | ear)
            | hips | belly | chest | panel | neck | antenna | head & ~(pair(eye) | mouth)

return {
  image = { width = 400, height = 500, spp = 1, exposure = -1 },
  camera = { eye = {4.6, 4.6, 9.6}, target = {0.05, 2.62, 0.1}, up = {0, 1, 0}, fov = 33 },
  lights = { area_light{ position = {-5, 10, 8}, u = {2, 0, 1.2}, v = {-0.9, -1.6, 1.5},
                         color = {1, 0.96, 0.9}, power = 3600 } },
  background = sky{ horizon = {0.50, 0.54, 0.60}, zenith = {0.28, 0.35, 0.45} },
  solids = {
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.52, 0.50, 0.47} }),
    rounded(r, robot):material(plastic{ color = {0.70, 0.30, 0.03}, roughness = 0.32 }),
  },
}
