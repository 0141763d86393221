-- A pair of dice, 16 mm. The pips are balls that are taken out of a rounded cube, in a colour of their own.
local r = param("r", 2)
local size = 16

-- Where the pips of 1 … 6 stand on a face, in quarters of its side from the middle.
local pips = {
  { {0, 0} },
  { {-1, -1}, {1, 1} },
  { {-1, -1}, {0, 0}, {1, 1} },
  { {-1, -1}, {-1, 1}, {1, -1}, {1, 1} },
  { {-1, -1}, {-1, 1}, {0, 0}, {1, -1}, {1, 1} },
  { {-1, -1}, {-1, 0}, {-1, 1}, {1, -1}, {1, 0}, {1, 1} },
}
-- Turns that bring the top to each face; opposite faces add up to 7.
local turns = { {0, {1, 0, 0}}, {90, {1, 0, 0}}, {90, {0, 1, 0}}, {-90, {0, 1, 0}}, {-90, {1, 0, 0}}, {180, {1, 0, 0}} }

local function die(color)
  local h = size / 2
  local body = rounded(r, box({-h, -h, -h}, {h, h, h}))
  for face = 1, 6 do
    for _, at in ipairs(pips[face]) do
      local pip = ellipsoid{ center = {at[1] * size / 4, at[2] * size / 4, h + 0.6}, radius = 1.9 }
      body = body - pip:rotate(turns[face][1], turns[face][2]):material(matte{ color = 0.85 })
    end
  end
  return body:material(plastic{ color = color, roughness = 0.25 })
end

return {
  up = "z",
  camera = frame{ from = {2, -4, 2.4} },
  solids = {
    die({0.55, 0.03, 0.04}):rotate(20, {0, 0, 1}):translate(0, 0, size / 2):name("red"),
    die({0.02, 0.08, 0.3}):rotate(90, {1, 0, 0}):rotate(-35, {0, 0, 1}):translate(24, 9, size / 2):name("blue"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.45, 0.44, 0.42} }),
  },
}
