-- integer.c in Lua, whose integers have 64 bits: what has 32 in C is cut to them.
local hash = 0

local function length(n)
  local steps = 1
  while n ~= 1 do
    if n & 1 ~= 0 then n = (3 * n + 1) & 0xffffffff else n = n >> 1 end
    steps = steps + 1
  end
  return steps
end

local best, longest = 0, 0
for n = 1, 1499999 do
  local steps = length(n)
  hash = ((hash ~ steps) * 16777619 + n % 7 - n // 13) & 0xffffffff
  if steps > longest then longest, best = steps, n end
end
print(string.format("%d takes %d steps, hash %08x", best, longest, hash))
