//@ args: check
#include "KMotionDef.h"

main()
{
    double angle;
    int degrees;

    for (degrees = 0; degrees < 360; degrees += 45)
        printf("%.1f\n", 500.0 * cos(degrees * PI / 180));
    for (angle = 0; angle < TWO_PI; angle += PI / 4)
        printf("%.1f\n", 500.0 * cos(angle));
    for (angle = 0; angle < 100; angle += 0.1)
        printf("%.1f\n", 500.0 * cos(angle));
}
