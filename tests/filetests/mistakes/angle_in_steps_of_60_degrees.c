//@ args: check
//@ says: warning[degrees]: `cos` takes radians, and `angle` is a multiple of 60
//@ says: warning[degrees]: `sin` takes radians, and `i * 60.0` is a multiple of 60
//@ says: angle_in_steps_of_60_degrees.c:14:44
#include "KMotionDef.h"

main()
{
    int i;
    double angle;
    for (i = 0; i < 6; i++)
    {
        angle = i * 60.0;
        printf("%.1f %.1f\n", 1000.0 * cos(angle), 1000.0 * sin(i * 60.0));
    }
}
