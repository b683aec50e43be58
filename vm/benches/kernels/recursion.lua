-- recursion.c in Lua.
local function fibonacci(n)
  if n < 2 then return n end
  return fibonacci(n - 1) + fibonacci(n - 2)
end

local function ackermann(m, n)
  if m == 0 then return n + 1 end
  if n == 0 then return ackermann(m - 1, 1) end
  return ackermann(m - 1, ackermann(m, n - 1))
end

local sum = 0
for round = 0, 399 do sum = sum + ackermann(2, 25 + round % 5) end
print(string.format("%d %d", fibonacci(41), sum))
