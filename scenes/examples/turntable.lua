-- A model on a turntable. Frames of a film:
-- for a in $(seq 0 5 355); do deburr render turntable.lua -D angle=$a -o $a.png; done
local angle = param("angle", 25)
local r = param("r", 0.6)

local function disk(radius)
  local points = {}
  for i = 1, 96 do
    local a = 2 * math.pi * i / 96
    points[i] = { radius * math.cos(a), radius * math.sin(a) }
  end
  return points
end

local model = (box({-8, -8, 0}, {8, 8, 16}) | box({-12, -4, 0}, {12, 4, 8}))
  & ~box({-4, -20, 4}, {4, 20, 12}) & ~box({-20, -2, 2}, {20, 2, 6})

return {
  up = "z",
  camera = { eye = {36, -62, 34}, target = {0, 0, 6.5}, fov = 30 },
  solids = {
    rounded(r, model):rotate(angle, {0, 0, 1}):translate(0, 0, 3)
      :material(plastic{ color = {0.6, 0.3, 0.02} }):name("model"),
    rounded(0.4, prism(disk(18), 0.8, 3)):material(matte{ color = 0.75 }):name("plate"),
    rounded(0.3, prism(disk(14), 0, 2)):material(matte{ color = 0.2 }):name("foot"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.45, 0.45, 0.47} }),
  },
}
