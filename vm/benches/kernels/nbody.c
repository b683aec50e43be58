// Five bodies that attract each other: structures of doubles, square roots.

int printf(const char *format, ...);
double sqrt(double x);

struct body {
    double x, y, z, vx, vy, vz, mass;
};

static struct body bodies[5] = {
    {0, 0, 0, 0, 0, 0, 39.478},
    {4.841, -1.160, -0.104, 0.606, 2.812, -0.0252, 0.0377},
    {8.343, 4.125, -0.403, -1.011, 1.826, 0.00842, 0.0113},
    {12.894, -15.111, -0.223, 1.083, 0.869, -0.0108, 0.00172},
    {15.379, -25.919, 0.179, 0.979, 0.595, -0.0347, 0.00203},
};

static void advance(double dt)
{
    int i, j;

    for (i = 0; i < 5; i++)
        for (j = i + 1; j < 5; j++) {
            struct body *a = &bodies[i], *b = &bodies[j];
            double dx = a->x - b->x, dy = a->y - b->y, dz = a->z - b->z;
            double square = dx * dx + dy * dy + dz * dz;
            double pull = dt / (square * sqrt(square));

            a->vx -= dx * b->mass * pull;
            a->vy -= dy * b->mass * pull;
            a->vz -= dz * b->mass * pull;
            b->vx += dx * a->mass * pull;
            b->vy += dy * a->mass * pull;
            b->vz += dz * a->mass * pull;
        }
    for (i = 0; i < 5; i++) {
        bodies[i].x += dt * bodies[i].vx;
        bodies[i].y += dt * bodies[i].vy;
        bodies[i].z += dt * bodies[i].vz;
    }
}

int main(void)
{
    int step;

    for (step = 0; step < 4000000; step++)
        advance(0.001);
    printf("%.9f %.9f %.9f\n", bodies[1].x, bodies[2].y, bodies[3].z);
    return 0;
}
