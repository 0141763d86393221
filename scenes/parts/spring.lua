-- A compression spring about the y axis, from y0 up to y1, its ends closed to rings.
--
-- A turn is two halves of tori, one on either side of the plane x = 0, leaned about the x axis against each other. Where
-- they meet, both run along x: the wire goes on without a bend. `coil` and `wire` are the radii of the spring's circle
-- and of the wire.

return function(coil, wire, y0, y1, turns)
  local lowest, halves = y0 + wire, 2 * turns
  local rise = (y1 - y0 - 2 * wire) / halves  -- of half a turn
  local lean = math.deg(math.asin(0.5 * rise / coil))
  local right, left = halfspace({-1, 0, 0}, 0), halfspace({1, 0, 0}, 0)

  -- The ends are whole rings; the wire leaves the lower one at z = -coil and joins the upper one at z = ±coil.
  local ring = torus{ axis = {0, 1, 0}, radius = coil, tube = wire }
  local spring = ring:translate(0, lowest, 0) | ring:translate(0, y1 - wire, 0)
  for i = 0, halves - 1 do
    local side = i % 2 == 0 and 1 or -1
    local half = ring:rotate(-side * lean, {1, 0, 0}):translate(0, lowest + (i + 0.5) * rise, 0)
    spring = spring | half & (side == 1 and right or left)
  end
  return spring
end
