-- Two staplers on a desk: Lobb's figure 14, "the use of rounding to achieve a softer more natural
-- appearance". Both are the same model; in the front one every part has a radius of its own, in the
-- back one all radii are 0. Lengths are centimetres.
--
--   -D show=rounded   only the rounded one (Triage, figures 19 and 20); also show=sharp
--   -D softness=2     all radii times two; 0 makes everything sharp
--   -D columns=round  round pins in bores, and a spring; the papers' pins are octagonal

local softness = param("softness", 1)
local show = param("show", "both")
local round = param("columns", "octagonal") == "round"
local spring = include("parts/spring.lua")

local red = plastic{ color = {0.46, 0.018, 0.020}, roughness = 0.34 }
local black = plastic{ color = {0.018, 0.018, 0.020}, roughness = 0.55 }
local steel = metal{ color = {0.60, 0.59, 0.57}, roughness = 0.38 }
local dark_steel = metal{ color = {0.36, 0.36, 0.37}, roughness = 0.42 }

-- A convex outline in x and y, raised along z.
local function profile(outline, z0, z1)
  local flat = {}
  for i, p in ipairs(outline) do flat[i] = {p[1], -p[2]} end
  return prism(flat, z0, z1):rotate(90, {1, 0, 0})
end

-- An outline in x and z that shrinks by `inset` on its way from y0 up to y1.
local function frustum(outline, y0, y1, inset)
  local cx, cz, n = 0, 0, #outline
  for _, p in ipairs(outline) do cx, cz = cx + p[1] / n, cz + p[2] / n end
  local points = {}
  for _, p in ipairs(outline) do
    local dx, dz = p[1] - cx, p[2] - cz
    points[#points + 1] = {p[1], y0, p[2]}
    points[#points + 1] = {p[1] - inset * (dx > 0 and 1 or -1), y1, p[2] - inset * (dz > 0 and 1 or -1)}
  end
  return convex(points)
end

-- Eight planes around the z axis, or a cylinder.
local function column(radius)
  if round then return cylinder{ from = {0, 0, -50}, to = {0, 0, 50}, radius = radius } end
  local sides
  for i = 0, 7 do
    local a = math.pi * (i + 0.5) / 4
    local plane = halfspace({math.cos(a), math.sin(a), 0}, radius)
    sides = sides and sides * plane or plane
  end
  return sides
end

-- A column and two ends: with one radius for the sides and another for the ends it becomes a round
-- pin with flattened ends (Triage, section 4.5.3).
local function pin(radius, z0, z1, side_rounding, end_rounding)
  local ends = halfspace({0, 0, 1}, z1) * halfspace({0, 0, -1}, -z0)
  return column(radius):radius(side_rounding) * ends:radius(end_rounding)
end

-- The density with a hole along z through the point, for a pin to turn in.
local function bored(density, x, y, radius)
  return round and density & ~column(radius):translate(x, y, 0) or density
end

local function mirrored(z_positive) return z_positive | z_positive:mirror({0, 0, 1}) end

local function stapler(soft)
  local function part(r, density, material) return rounded(soft * r, density):material(material) end
  local function soft_pin(radius, z0, z1)
    return rounded(0, pin(radius, z0, z1, soft * 0.45 * radius, soft * 0.22 * radius))
  end

  -- The base: a rubber foot, a body that narrows upwards, and a steel plate let into it.
  local outline = {{-0.5, -0.8}, {0.1, -1.5}, {9, -1.72}, {12.7, -1.5}, {13.5, -0.8},
                   {13.5, 0.8}, {12.7, 1.5}, {9, 1.72}, {0.1, 1.5}, {-0.5, 0.8}}
  local foot = part(0.10, frustum(outline, 0, 0.42, 0.0), black)
  local body = part(0.20, frustum(outline, 0.3, 1.0, 0.22), red)
  local plate = part(0.05, prism({{0.3, -1.12}, {12.5, -1.12}, {12.9, -0.7},
                                  {12.9, 0.7}, {12.5, 1.12}, {0.3, 1.12}}, 0.8, 1.1), steel)
  local pit = box({11.55, 1.17, 0.16}, {12.05, 2, 0.62})
  local anvil = part(0.04, box({11.1, 1.0, -0.86}, {12.5, 1.26, 0.86}) & ~(pit | pit:mirror({0, 0, 1})),
                     dark_steel)

  -- The hinge: two thin side plates on the base, and a pin through everything.
  local side = profile({{0.25, 1.0}, {3.5, 1.0}, {3.5, 1.35}, {2.35, 3.0}, {2.05, 3.2}, {0.95, 3.2}, {0.65, 3.0}, {0.25, 1.5}},
                       1.00, 1.13)
  local hinge = part(0.045, bored(side | side:mirror({0, 0, 1}), 1.5, 2.5, 0.33), steel)
  local hinge_pin = soft_pin(0.30, -1.30, 1.30):translate(1.5, 2.5, 0):material(dark_steel)

  -- The spring housing stands on the plate, its plunger reaches for the magazine. With round columns it is a cup,
  -- and one sees the spring.
  local housing = soft_pin(0.52, 1.0, 1.75):rotate(-90, {1, 0, 0}):translate(5, 0, 0):material(dark_steel)
  local plunger = soft_pin(0.33, 1.6, 3.0):rotate(-90, {1, 0, 0}):translate(5, 0, 0):material(steel)
  if round then
    local function upright(radius, y0, y1) return cylinder{ from = {5, y0, 0}, to = {5, y1, 0}, radius = radius } end
    local cup = upright(0.60, 1.0, 1.48) & ~upright(0.50, 1.2, 3)
    housing = part(0.05, cup, dark_steel)
      | part(0.01, spring(0.41, 0.06, 1.2, 2.52, 7):translate(5, 0, 0), steel)
    plunger = part(0.05, upright(0.28, 1.1, 3.0), dark_steel)
  end

  -- The upper half, closed: the magazine, a steel channel with a nose, under a cover whose sides
  -- are bent along the middle.
  local channel = box({1.0, 2.0, -0.80}, {12.4, 3.0, 0.80})
  local lips = box({3.9, 1.93, -0.90}, {12.3, 2.10, 0.90})
  local nose = box({12.2, 1.86, -0.86}, {12.62, 3.1, 0.86})
  local slot = box({12.28, 1, -0.62}, {12.42, 2.4, 0.62})
  local window = profile({{5.2, 2.3}, {10.6, 2.3}, {10.6, 2.52}, {5.2, 2.52}}, -2, 2)
  local magazine = part(0.06, (channel | lips | nose) & ~slot & ~window, steel)

  local ridge = {}
  for _, s in ipairs{-1, 1} do
    for _, p in ipairs{ {0.15, 2.75, 1.00}, {0.0, 3.35, 1.24}, {0.25, 3.95, 1.02}, {3.4, 4.62, 0.86},
                        {12.5, 4.02, 0.86}, {13.0, 3.70, 0.98}, {13.15, 3.40, 1.24}, {13.05, 2.75, 1.04},
                        {3.4, 3.45, 1.40}, {3.4, 2.75, 1.16} } do
      ridge[#ridge + 1] = {p[1], p[2], s * p[3]}
    end
  end
  local cavity = box({0.9, 2, -0.92}, {12.75, 3.3, 0.92})
  local cover = part(0.24, convex(ridge) & ~cavity:radius(soft * 0.05), red)
  local pad = part(0.09, box({-1.75, -0.2, -0.66}, {1.75, 0.10, 0.66}), black)
    :rotate(-math.deg(math.atan(0.60 / 9.1)), {0, 0, 1}):translate(10.4, 4.16, 0)
  local rivet = mirrored(soft_pin(0.20, 1.0, 1.34):translate(11.6, 3.25, 0)):material(steel)
  local knob = part(0.10, box({-0.25, 2.2, -0.62}, {1.2, 2.72, 0.62}), black)

  local upper = (magazine | cover | pad | rivet | knob)
    :translate(-1.5, -2.5, 0):rotate(6.5, {0, 0, 1}):translate(1.5, 2.5, 0)
  return foot | body | plate | anvil | hinge | hinge_pin | housing | plunger | upper
end

local solids = {}
if show ~= "rounded" then
  solids[#solids + 1] = stapler(0):translate(-6.5, 0, 0)
    :rotate(show == "both" and 17 or 0, {0, 1, 0}):translate(show == "both" and -2.0 or 0, 0, show == "both" and -4.6 or 0)
end
if show ~= "sharp" then
  solids[#solids + 1] = stapler(softness):translate(-6.5, 0, 0)
    :rotate(show == "both" and 17 or 0, {0, 1, 0}):translate(show == "both" and 1.4 or 0, 0, show == "both" and 2.2 or 0)
end

-- Boards of one tree each, with a fine gap between them.
for i = -16, 4 do
  local z = 5.2 * i
  local board = box({-110, -2, z + 0.015}, {70, 0, z + 5.185})
  solids[#solids + 1] = rounded(softness * 0.04, board):material(plastic{
    color = wood{ a = {0.46, 0.27, 0.125}, b = {0.31, 0.155, 0.06}, scale = 0.55, axis = {1, 0.012 * i, 0.01},
                  origin = {0, -3.5 - 1.3 * (i % 3), z + 1.7 + 1.1 * (i % 2)} },
    roughness = 0.45 })
end

return {
  image = { width = 600, height = 380, spp = 1, exposure = -0.4 },
  camera = { eye = {16, 15, 22}, target = {0.1, 1.2, -0.9}, up = {0, 1, 0}, fov = 25 },
  lights = {
    area_light{ position = {-14, 26, 12}, u = {5.2, 0, 6.1}, v = {-4.9, -4.6, 4.2},
                color = {1, 0.95, 0.88}, power = 19000 },
  },
  background = sky{ horizon = {0.52, 0.55, 0.60}, zenith = {0.30, 0.36, 0.46} },
  solids = solids,
}
