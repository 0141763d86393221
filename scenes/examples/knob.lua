-- A knob for a shaft of 6 mm with a flat side: a fluted grip, a skirt, and a line that points.
local r = param("r", 0.8)
local flutes = param("flutes", 12)

local function ring(radius, corners, wave)
  local points = {}
  for i = 1, corners do
    local a = 2 * math.pi * i / corners
    local here = radius + (wave or 0) * math.cos(flutes * a)
    points[i] = { here * math.cos(a), here * math.sin(a) }
  end
  return points
end

-- The shaft is round but for the flat.
local shaft = {}
for i, p in ipairs(ring(3.1, 48)) do shaft[i] = { math.min(p[1], 1.6), p[2] } end
local grip = prism(ring(11, 8 * flutes, 0.7), 2, 16, { axis = "z" })
local skirt = prism(ring(15, 64), 0, 3.5, { axis = "z" })
local line = box({-0.6, -12.5, 14.6}, {0.6, -3, 18}) | box({-0.6, -19, 1.8}, {0.6, -10.6, 18})
local bore = prism(shaft, -1, 12, { axis = "z" })

return {
  up = "z",
  camera = frame{ from = {1.6, -4, 3} },
  solids = {
    rounded(r, (grip | skirt) & ~bore):material(plastic{ color = {0.02, 0.02, 0.025}, roughness = 0.3 })
      - rounded(0.2, line):material(matte{ color = 0.85 }),
    sharp(halfspace({0, 0, 1}, 0)):material(metal{ color = {0.62, 0.61, 0.58}, roughness = 0.55 }),
  },
}
