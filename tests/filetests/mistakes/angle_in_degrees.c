//@ args: check
//@ says: warning[degrees]: `sin` takes radians, and 90 is more than a turn
//@ says: angle_in_degrees.c:8:24
#include "KMotionDef.h"

main()
{
    printf("%f\n", sin(90));
}
