-- A glazed tile, flat and without shadows, for the picture of image_map{} in docs/scenes.md:
--   deburr render docs/tile.lua -o docs/tile.png
local blue, light, white, grout = {0.02, 0.09, 0.36}, {0.12, 0.35, 0.62}, {0.86, 0.85, 0.8}, {0.36, 0.33, 0.3}
local solids = { sharp(box({-1, -0.2, -1}, {1, -0.1, 1})):material(matte{ color = grout }),
                 rounded(0.08, box({-0.47, -0.1, -0.47}, {0.47, 0.0, 0.47})):material(matte{ color = white }) }
local function add(solid, color) solids[#solids + 1] = solid:material(matte{ color = color }) end

for i = 0, 3 do
  local turn = 90 * i
  add(ellipsoid{ radii = {0.17, 0.05, 0.06} }:rotate(-45, {0, 1, 0})
        :translate(0.18, 0.1, 0.18):rotate(turn, {0, 1, 0}), light)
  add(ellipsoid{ center = {0.2, 0.2, 0}, radii = {0.17, 0.05, 0.055} }:rotate(turn, {0, 1, 0}), blue)
  local corner = cylinder{ from = {0.44, 0.1, 0.44}, to = {0.44, 0.15, 0.44}, radius = 0.2 }
  local ring = corner & ~cylinder{ from = {0.44, 0, 0.44}, to = {0.44, 0.3, 0.44}, radius = 0.13 }
  add((sharp(ring & box({-0.44, 0, -0.44}, {0.44, 1, 0.44}))):rotate(turn, {0, 1, 0}), blue)
end
add(ellipsoid{ center = {0, 0.3, 0}, radii = {0.06, 0.05, 0.06} }, white)

return {
  image = { width = 128, height = 128, spp = 16 },
  camera = { eye = {0, 5, 0}, target = {0, 0, 0}, up = {0, 0, -1}, fov = 11.421186, projection = "orthographic" },
  lights = {}, background = 0, ambient = 1,
  solids = solids,
}
