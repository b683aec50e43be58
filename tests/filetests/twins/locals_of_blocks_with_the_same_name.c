//@ args: check
#include "KMotionDef.h"

#define NX 5
#define NY 3
double Height[NY][NX];

main()
{
    int i, x, y;
    double best = 0;
    for (i = 0; i < 3; i++)
    {
        double z = ch2->Dest;
        int n = 0;
        if (z > best) best = z;
        while (n < i) n++;
    }
    for (i = 0; i < 3; i++)
    {
        double z = ch1->Dest;
        int x = i * 30;
        printf("%.1f %.1f %d\n", z, sin(x * PI / 180), x);
    }
    for (x = 0; x < NX; x++)
        for (y = 0; y < NY; y++)
            Height[y][x] = 10 * x + y;
    printf("%.1f\n", best + sin(i * 0.5) + sin(i * PI));
}
