local r = param("r", 0.08)
local body = box({0, 0, 0}, {2, 1, 1}) | box({1, 0, 0}, {3, 0.6, 1})
local bore = prism({{0.3, 0.3}, {0.7, 0.3}, {0.7, 0.7}, {0.3, 0.7}}, -1, 2)
return {
  camera = frame{ from = {5, 4, 6} },
  solids = { rounded(r, body & ~bore):material(plastic{ color = {0.7, 0.2, 0.1} }),
             sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = 0.5 }) },
}
