-- A spur gear with a hub, a bore with a keyway, and round windows.
local r = param("r", 0.35)
local teeth = param("teeth", 24)
local module = param("module", 2)
local width = param("width", 10)

local pitch = module * teeth / 2
local function ring(radius, corners, at)
  local points = {}
  for i = 1, corners do
    local a = 2 * math.pi * i / corners
    points[i] = { radius * math.cos(a) + (at and at[1] or 0), radius * math.sin(a) + (at and at[2] or 0) }
  end
  return points
end

-- A tooth as straight flanks of 20 degrees: narrow at the tip, wide at the root.
local outline = {}
local root, tip = pitch - 1.25 * module, pitch + module
local slope = math.tan(math.rad(20))
local function half_angle(radius) return (math.pi * module / 4 - (radius - pitch) * slope) / radius end
for i = 0, teeth - 1 do
  local middle = 2 * math.pi * i / teeth
  for _, p in ipairs{ {root, -1}, {tip, -1}, {tip, 1}, {root, 1} } do
    local a = middle + p[2] * half_angle(p[1])
    outline[#outline + 1] = { p[1] * math.cos(a), p[1] * math.sin(a) }
  end
end

local bore = ring(5, 48)
local key = { {-1.5, 0}, {1.5, 0}, {1.5, 7}, {-1.5, 7} }
local windows = {}
for i = 0, 4 do
  local a = 2 * math.pi * i / 5
  windows[#windows + 1] = ring(3.6, 32, { 13.5 * math.cos(a), 13.5 * math.sin(a) })
end

local body = prism(outline, 0, width, { axis = "z", holes = windows })
  | prism(ring(9, 48), 0, width + 5, { axis = "z" })
local shaft = prism(bore, -1, width + 9, { axis = "z" }) | prism(key, -1, width + 9, { axis = "z" })

return {
  up = "z",
  camera = frame{ from = {2, -4, 3.4} },
  solids = {
    rounded(r, body & ~shaft):material(metal{ color = {0.78, 0.6, 0.36}, roughness = 0.35 }):name("gear"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.4, 0.4, 0.42} }),
  },
}
