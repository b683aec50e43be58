//@ args: check
//@ says: warning[array-bounds]: `Height` has no element 4
//@ says: `x` is 4 and `y` is 2 in the last iterations of the loops
//@ says: indexes_of_a_table_swapped.c:17:21
#include "KMotionDef.h"

#define NX 5
#define NY 3
double Height[NY][NX];

main()
{
    int x, y;
    for (x = 0; x < NX; x++)
    {
        for (y = 0; y < NY; y++)
            Move(2, Height[x][y]);
        while (!CheckDone(2)) WaitNextTimeSlice();
    }
}
