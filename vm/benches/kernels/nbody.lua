-- nbody.c in Lua.
local sqrt = math.sqrt
local bodies = {}
for i, v in ipairs({
  { 0, 0, 0, 0, 0, 0, 39.478 },
  { 4.841, -1.160, -0.104, 0.606, 2.812, -0.0252, 0.0377 },
  { 8.343, 4.125, -0.403, -1.011, 1.826, 0.00842, 0.0113 },
  { 12.894, -15.111, -0.223, 1.083, 0.869, -0.0108, 0.00172 },
  { 15.379, -25.919, 0.179, 0.979, 0.595, -0.0347, 0.00203 },
}) do
  bodies[i] = { x = v[1] + 0.0, y = v[2] + 0.0, z = v[3] + 0.0, vx = v[4] + 0.0, vy = v[5] + 0.0, vz = v[6] + 0.0, mass = v[7] }
end

local function advance(dt)
  for i = 1, 5 do
    local a = bodies[i]
    for j = i + 1, 5 do
      local b = bodies[j]
      local dx, dy, dz = a.x - b.x, a.y - b.y, a.z - b.z
      local square = dx * dx + dy * dy + dz * dz
      local pull = dt / (square * sqrt(square))
      a.vx = a.vx - dx * b.mass * pull
      a.vy = a.vy - dy * b.mass * pull
      a.vz = a.vz - dz * b.mass * pull
      b.vx = b.vx + dx * a.mass * pull
      b.vy = b.vy + dy * a.mass * pull
      b.vz = b.vz + dz * a.mass * pull
    end
  end
  for i = 1, 5 do
    local a = bodies[i]
    a.x = a.x + dt * a.vx
    a.y = a.y + dt * a.vy
    a.z = a.z + dt * a.vz
  end
end

for _ = 1, 4000000 do advance(0.001) end
print(string.format("%.9f %.9f %.9f", bodies[2].x, bodies[3].y, bodies[4].z))
