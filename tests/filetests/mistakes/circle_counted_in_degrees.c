//@ args: check
//@ says: warning[degrees]: `cos` takes radians, and `angle` counts up to 360
//@ says: circle_counted_in_degrees.c:12:38
//@ says: write `cos(angle * PI / 180)`
#include "KMotionDef.h"

main()
{
    double angle;

    for (angle = 0; angle < 360; angle += 45)
        printf("%.1f\n", 500.0 * cos(angle));
}
