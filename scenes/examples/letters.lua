-- A name plate: letters are polygons with holes, rounded together with the plate.
local r = param("r", 0.25)

local letters = {
  D = { { {0, 0}, {3, 0}, {4, 1}, {4, 5}, {3, 6}, {0, 6} },
        { {1.2, 1.2}, {2.5, 1.2}, {2.8, 1.5}, {2.8, 4.5}, {2.5, 4.8}, {1.2, 4.8} } },
  E = { { {0, 0}, {3.8, 0}, {3.8, 1.2}, {1.2, 1.2}, {1.2, 2.4}, {3.2, 2.4}, {3.2, 3.6}, {1.2, 3.6}, {1.2, 4.8},
          {3.8, 4.8}, {3.8, 6}, {0, 6} } },
  B = { { {0, 0}, {3.2, 0}, {4, 0.8}, {4, 2.5}, {3.5, 3}, {4, 3.5}, {4, 5.2}, {3.2, 6}, {0, 6} },
        { {1.2, 1.2}, {2.6, 1.2}, {2.8, 1.4}, {2.8, 2.2}, {2.6, 2.4}, {1.2, 2.4} },
        { {1.2, 3.6}, {2.6, 3.6}, {2.8, 3.8}, {2.8, 4.6}, {2.6, 4.8}, {1.2, 4.8} } },
  U = { { {0, 1}, {1, 0}, {3, 0}, {4, 1}, {4, 6}, {2.8, 6}, {2.8, 1.5}, {2.5, 1.2}, {1.5, 1.2},
          {1.2, 1.5}, {1.2, 6}, {0, 6} } },
  R = { { {0, 0}, {1.2, 0}, {1.2, 2.2}, {1.7, 2.2}, {2.8, 0}, {4.1, 0}, {2.9, 2.4}, {4, 3.4}, {4, 5}, {3, 6}, {0, 6} },
        { {1.2, 3.4}, {2.5, 3.4}, {2.8, 3.7}, {2.8, 4.5}, {2.5, 4.8}, {1.2, 4.8} } },
}

local name = param("name", "DEBURR")
local text
for i = 1, #name do
  local shape = letters[name:sub(i, i)] or error("name: expected letters of DEBURR, got '" .. name:sub(i, i) .. "'")
  local holes = {}
  for k = 2, #shape do holes[k - 1] = shape[k] end
  local letter = prism(shape[1], 0.5, 2.4, { axis = "z", holes = holes }):translate(4.9 * (i - 1), 0, 0)
  text = text and text | letter or letter
end
local plate = box({-1.6, -1.6, 0}, {4.9 * #name + 0.7, 7.6, 1})

return {
  up = "z",
  image = { width = 640, height = 340 },
  camera = frame{ from = {0.8, -3, 3.2} },
  solids = {
    rounded(r, text):material(plastic{ color = {0.85, 0.8, 0.7}, roughness = 0.3 }):name("letters"),
    rounded(r, plate):material(plastic{ color = {0.1, 0.02, 0.03}, roughness = 0.25 }):name("plate"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.5, 0.49, 0.47} }),
  },
}
