-- A shelf bracket: an L with a brace, and holes for screws whose heads are sunk.
local r = param("r", 1)
local width = param("width", 24)
local t = 5

local profile = { {0, 0}, {90, 0}, {90, t}, {t, t}, {t, 70}, {0, 70} }
local brace = { {t - 1, t - 1}, {70, t - 1}, {70, t}, {t, 55}, {t - 1, 55} }
local window = { {11, 11}, {46, 11}, {11, 38} }

local function ring(cx, cy, radius)
  local points = {}
  for i = 1, 32 do
    local a = 2 * math.pi * i / 32
    points[i] = { cx + radius * math.cos(a), cy + radius * math.sin(a) }
  end
  return points
end

-- A hole for a screw, and the wider one for its head.
local function screw(u, v, axis)
  return prism(ring(u, v, 2.3), -9, 20, { axis = axis }) | prism(ring(u, v, 4.4), t - 2, 20, { axis = axis })
end

local body = prism(profile, 0, width, { axis = "y" })
  | prism(brace, width / 2 - 2.5, width / 2 + 2.5, { axis = "y", holes = { window } })
local holes = screw(width / 2, 62, "x") | screw(80, width / 2, "z")

return {
  up = "z",
  camera = frame{ from = {3, -4, 2.2} },
  solids = {
    rounded(r, body & ~holes):material(metal{ color = {0.62, 0.63, 0.66}, roughness = 0.45 }):name("bracket"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.42, 0.27, 0.17} }),
  },
}
