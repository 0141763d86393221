local twice = setmetatable({}, { __index = function(t, k) return k * 2 end, __len = function() return 3 end })
local list = { twice[2], #twice }
for i = 1, 3 do list[i] = math.random(i) .. string.format("%5.2f %q %x", i, "a", i) end
table.sort(list, function(a, b) return tostring(a) < tostring(b) end)
local ok, why = pcall(error, { "a" })
local co = coroutine.wrap(function(...) for i = 1, select("#", ...) do coroutine.yield(i) end end)
for k, v in pairs({ a = 1, [2] = 3, [true] = 4 }) do co(k, v) end
goto over
::over::
local text = table.concat({ ("a"):rep(3, ","), string.pack("<i4z", 7, "b"), ("x"):byte(1, -1) }, "\n", 1, 2)
print(text, #text, ok, why, tonumber("0x1p4"), 7 // 2, 7 % -3, 1 << 62, "a" < "b", math.tointeger(3.0))
return { solids = { rounded(param("r", 0.1), cube()) }, camera = { eye = {3, 2, 4}, fov = 30 } }
