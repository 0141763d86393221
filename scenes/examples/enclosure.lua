-- A box for electronics with posts, vents and a lid that sits in it. `deburr mesh --only lid` makes the lid alone.
local r = param("r", 1)
local x, y, z = param("x", 80), param("y", 50), param("z", 24)
local wall = 2.4
local clearance = 0.3

local function post(cx, cy, top)
  local corners, hole = {}, {}
  for i = 1, 16 do
    local a = math.pi * (i - 0.5) / 8
    corners[i] = { cx + 3.6 * math.cos(a), cy + 3.6 * math.sin(a) }
    hole[i] = { cx + 1.3 * math.cos(a), cy + 1.3 * math.sin(a) }
  end
  return prism(corners, 1, top, { axis = "z" }), prism(hole, 4, top + 9, { axis = "z" })
end

local body = box({0, 0, 0}, {x, y, z}) & ~box({wall, wall, wall}, {x - wall, y - wall, z + 9})
local holes = box({-1, 14, 7}, {wall + 1, 26, 13}) -- for a plug
for _, cx in ipairs{ 7, x - 7 } do
  for _, cy in ipairs{ 7, y - 7 } do
    local p, h = post(cx, cy, z - 8)
    body, holes = body | p, holes | h
  end
end
for i = 0, 5 do holes = holes | box({22 + 7 * i, -1, 7}, {25 + 7 * i, wall + 1, 17}) end

local inset = wall + clearance
local rim = box({inset, inset, 0}, {x - inset, y - inset, 5.5})
  & ~box({inset + 2, inset + 2, 2.4}, {x - inset - 2, y - inset - 2, 9})
local lid = box({0, 0, 0}, {x, y, 2.4}) | rim

return {
  up = "z",
  camera = frame{ from = {2.4, -4, 2.6} },
  solids = {
    rounded(r, body & ~holes):material(plastic{ color = {0.09, 0.1, 0.11}, roughness = 0.4 }):name("box"),
    rounded(r, lid):translate(0, y + 14, 0):material(plastic{ color = {0.75, 0.3, 0.03}, roughness = 0.4 }):name("lid"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.5, 0.5, 0.5} }),
  },
}
