-- A stand for a phone: one profile, drawn from the side, and a slot for the cable.
local r = param("r", 1.2)
local width = param("width", 70)

-- {y, z}: y to the back, z up. A foot, a lip that holds the phone, and a back that leans by 20 degrees.
local profile = {
  {0, 0}, {85, 0}, {85, 5}, {27, 5}, {57.2, 88}, {51, 88}, {23.3, 12}, {4.5, 12}, {4, 28}, {0, 28},
}
local stand = prism(profile, 0, width, { axis = "x" })
local slot = box({width / 2 - 7, -1, 5}, {width / 2 + 7, 40, 36})

return {
  up = "z",
  camera = frame{ from = {3.2, -4, 2.2} },
  solids = {
    rounded(r, stand & ~slot):material(plastic{ color = {0.04, 0.28, 0.34}, roughness = 0.35 }):name("stand"),
    sharp(halfspace({0, 0, 1}, 0)):material(matte{ color = {0.5, 0.49, 0.47} }),
  },
}
