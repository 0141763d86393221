-- A hole punch: Triage's figures 17 (sharp, -D softness=0) and 18. Lengths are centimetres.
--
-- Three parts show what section 6.1 tells of: the lever and the base are cuboids with a radius much
-- smaller than themselves; the punch pins are clipped by a plane of radius 0, which leaves them a
-- sharp edge at the top; the hinge's pins have one radius around and another at their ends.

local softness = param("softness", 1)
local closeup = param("closeup", "none")  -- punch, hinge or pins
-- The paper's columns are octagonal; -D columns=round has round ones, in bores, and springs that lift the punches.
local round = param("columns", "octagonal") == "round"
local spring = include("parts/spring.lua")

local function part(r, density, material) return rounded(softness * r, density):material(material) end

local shell = plastic{ color = {0.022, 0.095, 0.20}, roughness = 0.34 }
local rubber = plastic{ color = {0.016, 0.016, 0.018}, roughness = 0.6 }
local steel = metal{ color = {0.60, 0.59, 0.57}, roughness = 0.36 }
local dark_steel = metal{ color = {0.37, 0.37, 0.38}, roughness = 0.4 }

-- Eight planes around the z axis, or a cylinder.
local function column(radius)
  if round then return cylinder{ from = {0, 0, -50}, to = {0, 0, 50}, radius = radius } end
  local sides
  for i = 0, 7 do
    local a = math.pi * (i + 0.5) / 4
    local plane = halfspace({math.cos(a), math.sin(a), 0}, radius)
    sides = sides and sides * plane or plane
  end
  return sides
end

-- A pin along z with flattened ends: a radius for the sides, a smaller one for the ends.
local function pin(radius, z0, z1, material)
  local ends = halfspace({0, 0, 1}, z1) * halfspace({0, 0, -1}, -z0)
  return rounded(0, column(radius):radius(softness * 0.45 * radius) * ends:radius(softness * 0.22 * radius))
    :material(material)
end

local function both_sides(part) return part | part:mirror({1, 0, 0}) end

-- The tray that catches the chips, feet, and the steel bed on it.
local function slab(x, z0, z1, corner, y0, y1)
  return prism({{-x + corner, z0}, {x - corner, z0}, {x, z0 + corner}, {x, z1 - corner},
                {x - corner, z1}, {-x + corner, z1}, {-x, z1 - corner}, {-x, z0 + corner}}, y0, y1)
end
local foot = part(0.08, slab(6.3, -3.9, 3.3, 0.7, 0, 0.4), rubber)
local tray = part(0.20, slab(6.1, -3.7, 3.1, 0.7, 0.2, 1.15), shell)
local bed = part(0.06, slab(5.7, -3.2, 2.6, 0.4, 0.9, 1.32), steel)

-- A head guides its pin and has a slit for the paper, open to the front.
local head_block = box({-0.95, 1.2, -1.75}, {0.95, 3.0, 0.75})
local slit = box({-2, 1.50, -1.1}, {2, 1.68, 2})
if round then slit = slit | column(0.45):rotate(-90, {1, 0, 0}):translate(0, 0, -0.35) end
local head = part(0.11, head_block & ~slit, dark_steel):translate(3.9, 0, 0)

-- A rounded column, clipped: the density field is cut before anything is made of it.
local clip = halfspace({0, 1, 0}, 3.92):radius(0)
local punch_column = column(0.42):rotate(-90, {1, 0, 0}) * halfspace({0, -1, 0}, -1.35)
local punch = rounded(softness * 0.16, punch_column * clip):translate(3.9, 0, -0.35):material(steel)
local collar = pin(0.62, 3.0, 3.22, steel):rotate(-90, {1, 0, 0}):translate(3.9, 0, -0.35)
if round then
  -- The punch waits above the slit; its spring stands on the collar and lifts a ring.
  local function upright(radius, y0, y1) return cylinder{ from = {0, y0, 0}, to = {0, y1, 0}, radius = radius } end
  local lifted = part(0.02, spring(0.50, 0.042, 3.22, 3.70, 3), steel) | part(0.04, upright(0.57, 3.70, 3.80), dark_steel)
  punch = rounded(softness * 0.06, upright(0.42, 1.8, 3.92)):material(steel):translate(3.9, 0, -0.35)
    | lifted:translate(3.9, 0, -0.35)
  collar = part(0.05, upright(0.62, 2.9, 3.22) & ~upright(0.45, 2, 4), steel):translate(3.9, 0, -0.35)
end

-- The hinge: lugs on the bed, cheeks on the lever, a pin through both.
local lug = part(0.06, convex{ {2.30, 1.2, -3.1}, {2.30, 1.2, -1.1}, {2.30, 3.1, -2.75}, {2.30, 3.1, -2.05}, {2.30, 3.35, -2.4},
                               {2.48, 1.2, -3.1}, {2.48, 1.2, -1.1}, {2.48, 3.1, -2.75}, {2.48, 3.1, -2.05}, {2.48, 3.35, -2.4} },
                 steel)
local hinge_pin = pin(0.27, 2.02, 2.98, dark_steel):rotate(90, {0, 1, 0}):translate(0, 2.9, -2.4)

-- The lever: a plate that widens to the front, with cheeks and a grip, swung open about the hinge.
local plate = prism({{-3.1, -0.75}, {3.1, -0.75}, {4.9, 1.2}, {4.9, 5.6}, {4.1, 6.5}, {-4.1, 6.5}, {-4.9, 5.6}, {-4.9, 1.2}},
                    0.32, 0.86)
local lever = part(0.18, plate, shell)
local cheek = part(0.06, convex{ {2.56, 0.6, -0.6}, {2.56, 0.6, 1.6}, {2.56, -0.35, -0.35}, {2.56, -0.35, 0.35},
                                 {2.74, 0.6, -0.6}, {2.74, 0.6, 1.6}, {2.74, -0.35, -0.35}, {2.74, -0.35, 0.35} }, steel)
local grip = part(0.10, slab(3.6, 3.4, 5.9, 0.5, 0.7, 1.0), rubber)
local swung = (lever | both_sides(cheek) | grip):rotate(-21, {1, 0, 0}):translate(0, 2.9, -2.4)

-- The paper stop: a flat steel rule in the bed, with two pins.
local rule = part(0.05, box({5.2, 1.05, 0.9}, {9.0, 1.22, 1.9}), steel)
local stop = part(0.09, box({8.4, 1.0, 0.7}, {8.9, 1.75, 2.1}), rubber)
local pins = (pin(0.2, 1.1, 1.62, dark_steel):translate(6.7, -1.4, 0) | pin(0.2, 1.1, 1.62, dark_steel):translate(7.5, -1.4, 0))
  :rotate(-90, {1, 0, 0})

local views = {
  none = { eye = {13.5, 11.5, 16}, target = {1.0, 2.35, 0.2}, up = {0, 1, 0}, fov = 28 },
  punch = { eye = {8.2, 5.6, 7.6}, target = {3.95, 2.75, -0.3}, up = {0, 1, 0}, fov = 21 },
  hinge = { eye = {8.6, 5.2, -9.4}, target = {2.6, 2.6, -2.3}, up = {0, 1, 0}, fov = 19 },
  pins = { eye = {9.8, 4.4, 6.6}, target = {7.25, 1.35, 1.35}, up = {0, 1, 0}, fov = 24 },
}

return {
  image = { width = 600, height = 380, spp = 1, exposure = -0.4 },
  camera = views[closeup] or error("closeup: expected none, punch, hinge or pins, got " .. tostring(closeup)),
  lights = {
    area_light{ position = {-16, 22, -4}, u = {11, 10, 0}, v = {0, 0, 15}, color = {1, 0.97, 0.93}, power = 9000 },
    area_light{ position = {17, 11, 15}, u = {-9, 0, 9}, v = {-4, 7, -4}, color = {1, 0.9, 0.8}, power = 1900 },
    area_light{ position = {-8, 9, 24}, u = {0, 9, 0}, v = {15, 0, 8}, power = 2200 },
  },
  background = sky{ horizon = {0.30, 0.31, 0.33}, zenith = {0.36, 0.39, 0.44} },
  solids = {
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = {0.52, 0.50, 0.47} }),
    foot | tray | bed | both_sides(head | punch | collar | lug | hinge_pin) | swung | rule | stop | pins,
  },
}
