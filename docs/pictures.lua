-- The small pictures of docs/scenes.md, one for each value of the parameter `show`. `./run docs` renders them all.
local show = param("show", "densities")

local grey = {0.55, 0.54, 0.52}
local palette = { {0.62, 0.10, 0.05}, {0.72, 0.38, 0.03}, {0.10, 0.30, 0.08}, {0.03, 0.19, 0.42},
                  {0.26, 0.08, 0.34}, {0.05, 0.33, 0.36} }

local function plain(i) return plastic{ color = palette[(i - 1) % #palette + 1], roughness = 0.3 } end

local function polygon(corners, radius)
  local points = {}
  for i = 1, corners do
    local a = 2 * math.pi * i / corners
    points[i] = { radius * math.cos(a), radius * math.sin(a) }
  end
  return points
end

-- Everything below fits into the unit cube or nearly so, and stands on y = 0.
local block = box({0, 0, 0}, {0.7, 0.7, 1})
local peg = box({0.35, 0, 0.25}, {1, 1, 0.75})
local knob = cube() & ~box({0.25, 0.5, 0.25}, {0.75, 2, 0.75})

local other = cube():translate(0.5, 0.45, -0.2)

local function quadrics()
  local frame = sharp(box({-0.5, 0, -0.5}, {0.5, 1, 0.5}))
  local middle = {0, 0.5, 0}
  local list = {
    ellipsoid{ center = middle, radii = {0.5, 0.5, 0.35} } | ellipsoid{ center = middle, radii = {0.5, 0.5, 0.35} },
    cylinder{ radius = 0.4 } & frame,
    cone{ apex = middle, radius = 0.4, height = 0.5 } & frame,
    paraboloid{ radius = 0.45 } & frame,
    hyperboloid{ center = middle, radius = 0.22, height = 0.3 } & frame,
    hyperboloid{ center = middle, radius = 0.22, height = 0.2, sheets = 2 } & frame,
  }
  for i, solid in ipairs(list) do list[i] = solid:translate(0.5, 0, 0.5) end
  return list
end

local function rod(x, z, y0, y1, r) return cylinder{ from = {x, y0, z}, to = {x, y1, z}, radius = r } end

local function round_parts()
  local stand = box({0, 0, 0}, {1, 0.35, 1}) & ~rod(0.5, 0.5, -1, 1, 0.22)
  for x = 0.17, 1, 0.66 do for z = 0.17, 1, 0.66 do stand = stand | rod(x, z, 0.1, 0.75, 0.09) end end
  return {
    rounded(0.05, stand),
    rounded(0.06, cone{ from = {0.5, 0, 0.5}, to = {0.5, 1, 0.5}, radius = {0.5, 0} }),
    rounded(0.05, rod(0.5, 0.5, 0, 0.5, 0.5) & ~torus{ center = {0.5, 0.25, 0.5}, radius = 0.5, tube = 0.15 } & ~rod(0.5, 0.5, -1, 1, 0.15)),
    rounded(0.05, sphere{ center = {0.5, 0.5, 0.5}, radius = 0.5 } & ~cylinder{ from = {0, 0.5, -1}, to = {1, 0.5, 2}, radius = 0.2 }),
  }
end

local pebble = ellipsoid{ center = {0.5, 0.45, 0.5}, radii = {0.55, 0.45, 0.5} }
local bump = ellipsoid{ center = {0.85, 0.75, 0.7}, radius = 0.4 }

local ball = ellipsoid{ center = {0.5, 0.5, 0.5}, radius = 0.5 }
local die = rounded(0.2, cube())
local angle = model("angle.obj")

local pictures = {
  densities = { sharp(cube()), sharp(box({0, 0, 0.2}, {1, 0.5, 0.8})),
                sharp(convex{ {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, 1, 0.5} }),
                sharp(prism(polygon(6, 0.5), 0, 0.8)):translate(0.5, 0, 0.5) },
  roundings = { sharp(knob), rounded(0.05, knob), rounded(0.12, knob), rounded(0.2, knob), convolved(0.2, knob) },
  operators = { rounded(0.07, block | peg), rounded(0.07, block & peg), rounded(0.07, block & ~peg) },
  flow = { rounded(0.15, cube() | other):scale(0.68), (rounded(0.15, cube()) | rounded(0.15, other)):scale(0.68) },
  radius = { rounded(0.25, cube()), rounded(0.25, cube() * halfspace({0, 1, 0}, 0.8):radius(0.03)) },
  quadrics = quadrics(),
  round_parts = round_parts(),
  freeform = { pebble | pebble, freeform(pebble, { perturbation(3, bump) }),
               freeform(pebble, { perturbation(-3, bump) }) },
  materials = { die:material(matte{ color = palette[2] }), die:material(plastic{ color = palette[2] }),
                die:material(metal{ color = {0.85, 0.55, 0.2} }), die:material(mirror{}), die:material(glass{}) },
  roughness = { ball:material(metal{ roughness = 0 }), ball:material(metal{ roughness = 0.2 }),
                ball:material(metal{ roughness = 0.4 }), ball:material(metal{ roughness = 0.7 }),
                ball:material(metal{ roughness = 1 }) },
  textures = { die:material(matte{ color = checker{ a = {0.7, 0.2, 0.1}, b = 0.75, scale = 0.25 } }),
               die:material(plastic{ color = wood{ scale = 0.09, origin = {0, -0.3, 0.4} } }) },
  patterns = { die:material(plastic{ color = marble{ scale = 0.45, axis = {1, 0.4, 0.6} }, roughness = 0.08 }),
               die:material(plastic{ color = {0.32, 0.05, 0.03}, roughness = 0.25, bump = noise{ scale = 0.07 }, bump_height = 0.012 }),
               die:material(metal{ color = {0.72, 0.73, 0.75}, roughness = brushed{ a = 0.15, b = 0.35, scale = 0.02 }, bump = brushed{ scale = 0.02 }, bump_height = 0.0025 }),
               ball:material(metal{ color = {0.85, 0.6, 0.25}, roughness = 0.15,
                                    bump = brushed{ scale = 0.02, axis = {0, 1, 0}, around = true, origin = {1.6, 0, 0} }, bump_height = 0.003 }),
               die:material(plastic{ color = image_map{ file = "tile.png", scale = 0.5, origin = {2.7, 0, 0.5} }, roughness = 0.1 }) },
  keep_sharp = { sharp(angle), convolved(0.12, angle), convolved(0.12, angle, { edges = "convex" }),
                 convolved(0.12, angle, { edges = "concave" }),
                 convolved(0.12, angle, { keep_sharp = { below = 0.45 } }) },
  point_light = { die }, directional_light = { die }, area_light = { die },
}

local list = pictures[show]
if not list then error("show: expected one of the pictures of docs/scenes.md, got '" .. tostring(show) .. "'") end

-- Without bounces a picture has no noise, and its file is small; only what reflects needs them.
local reflects = show == "materials" or show == "roughness" or show == "patterns"
local ground = show == "materials" and checker{ a = 0.6, b = 0.3, scale = 0.8, origin = {0, 0.2, 0} } or grey

local step = 1.6
local solids = { sharp(halfspace({0, 1, 0}, 0)):material(matte{ color = ground }):name("ground") }
for i, solid in ipairs(list) do
  solids[#solids + 1] = solid:translate(-0.5, 0, -0.5):rotate(reflects and 0 or -28, {0, 1, 0})
    :translate(step * (i - 1 - (#list - 1) / 2), 0, 0):material(plain(i))
end

local sun = directional_light{ direction = {0.8, -1.3, -0.7}, power = 1.4 }
local lamps = {
  point_light = point_light{ position = {-1.2, 1.9, 1.2}, power = 75 },
  area_light = area_light{ position = {-1.2, 1.9, 1.2}, u = {0.8, 0, 0.8}, v = {-0.5, -0.7, 0.5}, power = 24, samples = 64 },
}

return {
  image = { width = 16 + 80 * #list, height = 96, spp = reflects and 400 or 64, bounces = reflects and 6 or 0 },
  camera = { eye = {0, 4.4, 7.2}, target = {0, 0.38, 0}, fov = 13.4 },
  lights = { lamps[show] or sun },
  background = reflects and sky{ horizon = 0.7, zenith = {0.2, 0.3, 0.5} } or 0.3,
  solids = solids,
}
