-- sieve.c in Lua.
local composite = {}

local function sieve(limit)
  local count = 0
  for i = 0, limit - 1 do composite[i] = 0 end
  for i = 2, limit - 1 do
    if composite[i] == 0 then
      count = count + 1
      for j = 2 * i, limit - 1, i do composite[j] = 1 end
    end
  end
  return count
end

local count = 0
for round = 0, 799 do count = count + sieve(300000 - round) end
print(string.format("%d primes", count))
