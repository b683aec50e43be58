-- matrix.c in Lua.
local N = 120
local a, b, c = {}, {}, {}
for i = 0, N - 1 do
  a[i], b[i], c[i] = {}, {}, {}
  for j = 0, N - 1 do
    a[i][j] = (i + 2 * j) % 7 / 8.0
    b[i][j] = math.fmod(3 * i - j, 5) / 16.0
  end
end

local function multiply()
  for i = 0, N - 1 do
    local ai, ci = a[i], c[i]
    for j = 0, N - 1 do
      local sum = 0.0
      for k = 0, N - 1 do sum = sum + ai[k] * b[k][j] end
      ci[j] = sum
    end
  end
end

for _ = 1, 400 do
  multiply()
  for i = 0, N - 1 do
    for j = 0, N - 1 do a[i][j] = 0.9 * a[i][j] + c[i][j] / 64.0 + i / 1024.0 end
  end
end
local trace = 0.0
for i = 0, N - 1 do trace = trace + c[i][i] end
print(string.format("trace %.12f", trace))
