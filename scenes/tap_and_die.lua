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

local tool = metal{ color = {0.56, 0.57, 0.6}, roughness = 0.2 }
return {
  image = { width = 720, height = 456 },
  camera = { eye = {1.4, 7.6, 13.2}, target = {-0.2, 2.0, 0}, fov = 31, lens = { radius = 0.08, focus = 13.2 } },
  lights = { area_light{ position = {-8, 9, -2}, u = {5, 5, 0}, v = {0, 0, 7}, power = 900, color = {1, 0.97, 0.93} },
             area_light{ position = {6, 6, 11}, u = {-6, 0, 4}, v = {0, 4, 0}, power = 700, color = {1, 0.9, 0.8} },
             area_light{ position = {0, 7, -11}, u = {9, 0, 0}, v = {0, 3, 3}, power = 500, color = {0.88, 0.94, 1} },
             area_light{ position = {-6, 3.5, 11}, u = {0, 4, 0}, v = {6, 0, 4}, power = 300 } },
  background = sky{ horizon = {0.14, 0.145, 0.16}, zenith = {0.26, 0.29, 0.34} },
  solids = {
    rounded(r, tap):rotate(-90, {0, 0, 1}):rotate(24, {0, 1, 0}):translate(-3.4, 1, 2.2):material(tool),
    rounded(r, die):rotate(90, {1, 0, 0}):rotate(-14, {0, 1, 0}):translate(1.6, 2.6, -1.9)
      :material(metal{ color = {0.55, 0.52, 0.49}, roughness = 0.26 }),
    sharp(halfspace({0, 1, 0}, 0)):material(plastic{ color = {0.10, 0.105, 0.115}, roughness = 0.32 }),
  },
}
