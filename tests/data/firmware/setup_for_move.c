// setup_for_move.c - the states of moves with and without their outer changes of acceleration.

#include "KMotionDef.h"

Go(double from, double to, float velocity, int start, int end)
{
    int n, i;
    SetupForMove(from, to, velocity, ch2, 0, start, end, 0, &n);
    printf("%g to %g at %g, %d %d: %d\n", from, to, velocity, start, end, n);
    for (i = 0; i < n; i++)
        printf("%.9f %.6f %.6f %.6f %.6f\n", ch2->c[i].t, ch2->c[i].a, ch2->c[i].b, ch2->c[i].c, ch2->c[i].d);
}

main()
{
    int i;
    ch2->Vel = 300;
    ch2->Accel = 3000;
    ch2->Jerk = 50000;
    for (i = 0; i < 4; i++)
    {
        Go(0, 1, 200, i & 1, i >> 1);
        Go(0, 35, 300, i & 1, i >> 1);
        Go(0, 1000, 300, i & 1, i >> 1);
        Go(5, -1000, 300, i & 1, i >> 1);
        Go(0, 1000, 100, i & 1, i >> 1);
        Go(0, 47, 300, i & 1, i >> 1);
        Go(0, 48.5, 300, i & 1, i >> 1);
    }
}
