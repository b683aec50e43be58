//@ args: check
//@ says: warning[array-bounds]: `home_speed` has no element 3
//@ says: axes_counted_from_1.c:11:15
//@ says: `axis` is 3 in the last iteration of this loop
#include "KMotionDef.h"

double home_speed[3] = { -4000, -4000, 3000 };

void Home(int axis)
{
    Jog(axis, home_speed[axis]);
    while (!ReadBit(136 + axis)) WaitNextTimeSlice();
    Jog(axis, 0);
}

main()
{
    int i;
    for (i = 1; i <= 3; i++) Home(i);
}
