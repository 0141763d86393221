-- A compression spring about the y axis, from y0 up to y1. `coil` and `wire` are the radii of its circle and of the
-- wire; `turns` is a whole number.
--
-- A turn is two halves of tori, one on either side of the plane x = 0, leaned about the x axis against each other. Where
-- they meet, both run along x: the wire goes on without a bend, and as the halves share the plane between them, rounding
-- does not show where they meet. The ends are cut off.

return function(coil, wire, y0, y1, turns)
  local halves = 2 * turns
  local rise = (y1 - y0 - 2 * wire) / halves  -- of half a turn
  local lean = math.deg(math.asin(0.5 * rise / coil))
  local right, left = halfspace({-1, 0, 0}, 0), halfspace({1, 0, 0}, 0)

  local ring, spring = torus{ axis = {0, 1, 0}, radius = coil, tube = wire }
  for i = 0, halves - 1 do
    local side = i % 2 == 0 and 1 or -1
    local half = ring:rotate(-side * lean, {1, 0, 0}):translate(0, y0 + wire + (i + 0.5) * rise, 0)
      & (side == 1 and right or left)
    spring = spring and spring | half or half
  end
  return spring
end
