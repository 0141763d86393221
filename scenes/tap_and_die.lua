-- A tap and a die: threads of cones, flutes and bores of cylinders, in one density each. The turns are rings; a helix is no
-- surface of revolution.
local r = param("r", 0.03)
local turns = param("turns", 8)
local pitch, crest, root = 0.36, 1.0, 0.8

-- Rings of a thread along y, `clear` wider than nominal.
local function thread(from, count, clear)
  local all
  for i = 0, count - 1 do
    local low, middle, high = from + i * pitch, from + (i + 0.5) * pitch, from + (i + 1) * pitch
    local ring = cone{ from = {0, low, 0}, to = {0, middle, 0}, radius = {root + clear, crest + clear} }
               | cone{ from = {0, middle, 0}, to = {0, high, 0}, radius = {crest + clear, root + clear} }
    all = all and (all | ring) or ring
  end
  return all
end
local function rod(x, z, low, high, radius) return cylinder{ from = {x, low, z}, to = {x, high, z}, radius = radius } end

-- The tap: thread and shank, four flutes, a tapered tip, a square end.
local length = turns * pitch
local tap = thread(0, turns, 0) | rod(0, 0, length - 0.1, length + 3, 0.74)
for i = 0, 3 do
  local a = math.pi / 4 + i * math.pi / 2
  tap = tap & ~rod(0.98 * math.cos(a), 0.98 * math.sin(a), -1, length + 0.7, 0.42)
end
tap = tap & cone{ from = {0, 0, 0}, to = {0, 20, 0}, radius = {0.72, 7.5} }
tap = tap & (box({-0.56, length + 2.2, -0.56}, {0.56, length + 3, 0.56}) | box({-2, -1, -2}, {2, length + 2.2, 2}))

-- The die: a disc whose bore is a thread, with four clearance holes.
local die = rod(0, 0, -0.72, 0.72, 2.6) & ~thread(-3 * pitch, 6, 0.02)
for i = 0, 3 do
  local a = math.pi / 4 + i * math.pi / 2
  die = die & ~rod(1.2 * math.cos(a), 1.2 * math.sin(a), -2, 2, 0.5)
end
die = die & ~box({2.3, -2, -0.12}, {3, 2, 0.12})

local tool = metal{ color = {0.56, 0.57, 0.6}, roughness = 0.24 }
return {
  image = { width = 720, height = 456 },
  camera = { eye = {1.4, 7.6, 13.2}, target = {-0.35, 1.95, 0}, fov = 32 },
  lights = { area_light{ position = {-6, 11, 6}, u = {0, 3, -4}, v = {5, 0, 0}, power = 1300 },
             area_light{ position = {9, 6, 4}, u = {-2, 0, 3}, v = {0, 4, 0}, power = 240, color = {1, 0.85, 0.7} } },
  background = sky{ horizon = {0.92, 0.92, 0.94}, zenith = {0.62, 0.68, 0.8} },
  solids = {
    rounded(r, tap):rotate(-90, {0, 0, 1}):rotate(24, {0, 1, 0}):translate(-3.4, 1, 2.2):material(tool),
    rounded(r, die):rotate(72, {1, 0, 0}):rotate(-14, {0, 1, 0}):translate(1.6, 2.62, -1.9)
      :material(metal{ color = {0.45, 0.42, 0.4}, roughness = 0.3 }),
    sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = 0.4 }),
  },
}
