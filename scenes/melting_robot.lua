-- A robot of blocks that touch but do not overlap, so that their sum is legal (Lobb, section 2.2):
-- with a growing radius they flow together, melt and vanish (Triage, section 6.4). -D r=0.5 is soft
-- already; robot.lua has more parts, and overlaps them.

local r = param("r", 0.08)

local function pair(x0, y0, z0, x1, y1, z1)
  return box({x0, y0, z0}, {x1, y1, z1}) + box({-x1, y0, z0}, {-x0, y1, z1})
end

-- Pits from the front: what sticks out of the face is clipped, as in obj4 of csg_examples.lua.
local function pit(shape) return halfspace({0, 0, 1}, 0.6) * shape end

local head = box({-0.5, 3.5, -0.3}, {0.5, 4.3, 0.6})
           - pit(box({-0.36, 3.95, 0.42}, {-0.12, 4.15, 1})) - pit(box({0.12, 3.95, 0.42}, {0.36, 4.15, 1}))
           - pit(box({-0.3, 3.65, 0.48}, {0.3, 3.75, 1}))
local robot = pair(0.2, 0, -0.3, 0.8, 0.3, 0.6)          -- feet
            + pair(0.2, 0.3, -0.3, 0.8, 1.8, 0.3)        -- legs
            + box({-0.8, 1.8, -0.3}, {0.8, 3.3, 0.3})    -- trunk
            + pair(0.8, 2.9, -0.3, 1.35, 3.3, 0.3)       -- shoulders
            + pair(0.95, 1.8, -0.3, 1.35, 2.9, 0.3)      -- arms
            + pair(0.95, 1.5, -0.3, 1.35, 1.8, 0.6)      -- hands
            + box({-0.2, 3.3, -0.3}, {0.2, 3.5, 0.3})    -- neck
            + head

return {
  image = { width = 400, height = 500, spp = 1, exposure = -1 },
  camera = { eye = {4.4, 4.2, 9.0}, target = {0.05, 2.02, 0.1}, up = {0, 1, 0}, fov = 30 },
  lights = { area_light{ position = {-5, 10, 8}, u = {2, 0, 1.2}, v = {-0.9, -1.6, 1.5},
                         color = {1, 0.96, 0.9}, power = 3600 } },
  background = sky{ horizon = {0.50, 0.54, 0.60}, zenith = {0.28, 0.35, 0.45} },
  solids = {
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.52, 0.50, 0.47} }),
    rounded(r, robot):material(plastic{ color = {0.70, 0.30, 0.03}, roughness = 0.32 }),
  },
}
