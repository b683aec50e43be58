// move_boundary.c - moves whose length is about that at which Accel begins to last: some of the board's lists jump.

#include "KMotionDef.h"

float vel[] = {100, 200, 300, 150, 50, 1000, 400, 500, 4000, 40000, 777, 64, 81};
float accel[] = {1000, 3000, 1000, 2000, 333, 4000, 2000, 5000, 20000, 400000, 1234, 128, 81};
float jerk[] = {10000, 50000, 1000, 40000, 10000, 7000, 30000, 70000, 300000, 4000000, 4321, 1024, 567};

Try(double distance)
{
    int i;
    EnableAxisDest(1, 0.0);
    Move(1, distance);
    printf("%.12g:", distance);
    for (i = 0; ch1->c[i].trajectory_mode; i++)
        if (ch1->c[i].t > 1e-6) printf(" %.4f %.3f %.4f", ch1->c[i].t, ch1->c[i].c, ch1->c[i].d);
    printf("\n");
    DisableAxis(1);
}

main()
{
    int set, power;
    ch1->InputMode = USER_INPUT_MODE;
    ch1->OutputMode = NO_OUTPUT_MODE;
    for (set = 0; set < 13; set++)
    {
        double way, peak = accel[set], delta = 1e-15;
        ch1->Vel = vel[set];
        ch1->Accel = accel[set];
        ch1->Jerk = jerk[set];
        if (peak * peak > (double)vel[set] * jerk[set]) peak = sqrt((double)vel[set] * jerk[set]);
        way = 2 * peak * (peak / jerk[set]) * (peak / jerk[set]);
        Try(way);
        Try(-way);
        for (power = 0; power < 5; power++, delta *= 100)
        {
            Try(way * (1 + delta));
            Try(-way * (1 + delta));
            Try(way * (1 - delta));
            Try(-way * (1 - delta));
        }
    }
}
