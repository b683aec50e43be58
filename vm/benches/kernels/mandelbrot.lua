-- mandelbrot.c in Lua.
local function iterations(x0, y0)
  local x, y = 0.0, 0.0
  for n = 0, 499 do
    local xx, yy = x * x, y * y
    if xx + yy > 4.0 then return n end
    y = 2.0 * x * y + y0
    x = xx - yy + x0
  end
  return 500
end

local sum = 0
for row = 0, 1199 do
  for column = 0, 1199 do
    sum = sum + iterations(column / 400.0 - 2.25, row / 400.0 - 1.5)
  end
end
print(string.format("%d iterations", sum))
