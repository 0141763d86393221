-- A lattice of struts as one shape: where they meet, every corner is filled.
local r = param("r", 0.5)
local cells = param("cells", 3)
local size, thick = 8, 1.6

local struts
local function add(lo, hi) local b = box(lo, hi) struts = struts and struts | b or b end
local whole, half = cells * size, thick / 2
for i = 0, cells do
  for k = 0, cells do
    local a, b = i * size, k * size
    add({-half, a - half, b - half}, {whole + half, a + half, b + half})
    add({a - half, -half, b - half}, {a + half, whole + half, b + half})
    add({a - half, b - half, -half}, {a + half, b + half, whole + half})
  end
end

return {
  up = "z",
  camera = frame{ from = {2.2, -4, 1.8} },
  solids = {
    rounded(r, struts):translate(0, 0, half)
      :material(plastic{ color = {0.06, 0.3, 0.5}, roughness = 0.3 }):name("lattice"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.5, 0.5, 0.5} }),
  },
}
