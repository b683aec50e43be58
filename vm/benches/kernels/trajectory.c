// A trajectory planner's arithmetic in doubles: third-order profiles, evaluated at each tick.

int printf(const char *format, ...);
double sqrt(double x);

struct piece {
    double a, b, c, d, t;
};

static struct piece pieces[4];

/* A move from rest to rest of a distance, limited in velocity and acceleration. */
static double plan(double distance, double vel, double accel)
{
    double ramp = vel / accel, cruise;

    if (ramp * vel > distance) {
        vel = sqrt(distance * accel);
        ramp = vel / accel;
    }
    cruise = (distance - ramp * vel) / vel;
    pieces[0].a = 0;
    pieces[0].b = 0.5 * accel;
    pieces[0].c = 0;
    pieces[0].d = 0;
    pieces[0].t = ramp;
    pieces[1].a = 0;
    pieces[1].b = 0;
    pieces[1].c = vel;
    pieces[1].d = 0.5 * ramp * vel;
    pieces[1].t = cruise;
    pieces[2].a = 0;
    pieces[2].b = -0.5 * accel;
    pieces[2].c = vel;
    pieces[2].d = 0.5 * ramp * vel + cruise * vel;
    pieces[2].t = ramp;
    return 2 * ramp + cruise;
}

static double evaluate(double t)
{
    int i = 0;
    struct piece *p;

    while (i < 2 && t > pieces[i].t) {
        t -= pieces[i].t;
        i++;
    }
    p = &pieces[i];
    return ((p->a * t + p->b) * t + p->c) * t + p->d;
}

int main(void)
{
    int move;
    double sum = 0, furthest = 0;

    for (move = 1; move <= 2500; move++) {
        double total = plan(move * 0.37, 40.0 + move % 50, 300.0), t;

        for (t = 0; t < total; t += 0.00018) {
            double x = evaluate(t);

            sum += x;
            if (x > furthest)
                furthest = x;
        }
    }
    printf("%.3f %.6f\n", sum, furthest);
    return 0;
}
