-- A small house, in metres: each material is a solid of its own.
local r = param("r", 0.04)

local gable = { {-3, 0}, {3, 0}, {3, 2.8}, {0, 5}, {-3, 2.8} }
local inner = { {-2.75, 0.2}, {2.75, 0.2}, {2.75, 2.7}, {0, 4.7}, {-2.75, 2.7} }
local along = { axis = "y" }
local walls = prism(gable, 0, 8, along) & ~prism(inner, 0.25, 7.75, along)

local openings = box({-2.1, -1, 0.2}, {-1.1, 1, 2.25}) | box({0.2, -1, 1}, {1.9, 1, 2.2})
  | box({-0.5, -1, 3}, {0.5, 1, 3.8})
for i = 0, 2 do openings = openings | box({2, 1.1 + 2.3 * i, 1}, {4, 2.3 + 2.3 * i, 2.2}) end

-- Two slabs that meet in the ridge.
local roof = prism({ {-3.6, 2.44}, {0, 5.08}, {3.6, 2.44}, {3.6, 2.72}, {0, 5.4}, {-3.6, 2.72} }, -0.5, 8.5, along)
local chimney = box({1.1, 5.6, 3.5}, {1.9, 6.4, 6}) & ~box({1.3, 5.8, 5}, {1.7, 6.2, 7})
local door = box({-2.1, 0.1, 0.2}, {-1.1, 0.18, 2.25})
local glass_panes = box({0.2, 0.1, 1}, {1.9, 0.15, 2.2}) | box({-0.5, 0.1, 3}, {0.5, 0.15, 3.8})
for i = 0, 2 do glass_panes = glass_panes | box({2.85, 1.1 + 2.3 * i, 1}, {2.9, 2.3 + 2.3 * i, 2.2}) end
local plinth = box({-3.3, -0.3, -1}, {3.3, 8.3, 0.12}) | box({-2.4, -1.2, -1}, {-0.8, 0, 0.1})

return {
  up = "z",
  camera = frame{ from = {3.2, -4, 1.5} },
  background = sky{},
  solids = {
    rounded(r, walls & ~openings):material(matte{ color = {0.72, 0.66, 0.55} }):name("walls"),
    rounded(r, roof):material(matte{ color = {0.42, 0.13, 0.07} }):name("roof"),
    rounded(r, chimney):material(matte{ color = {0.4, 0.2, 0.14} }):name("chimney"),
    rounded(0.01, door):material(plastic{ color = {0.05, 0.16, 0.12} }):name("door"),
    sharp(glass_panes):material(plastic{ color = {0.03, 0.05, 0.07}, roughness = 0.02 }):name("panes"),
    rounded(r, plinth):material(matte{ color = 0.4 }):name("plinth"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.2, 0.27, 0.1} }),
  },
}
