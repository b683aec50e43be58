//@ args: check
//@ says: warning[degrees]: `cos` takes radians, and `angle` is a multiple of 60
//@ says: holes_in_parts_of_360_degrees.c:14:39
#include "KMotionDef.h"

#define HOLES 6
main()
{
    int i;
    double angle;
    for (i = 0; i < HOLES; i++)
    {
        angle = i * 360.0 / HOLES;
        printf("%.0f\n", 4000.0 * cos(angle));
    }
}
