//@ exit: 3
//@ prints: length 0: 0.00
//@ says: thread 1 stopped at doubles_in_elements_one_apart.c:14:9 in `main`: read of 8 bytes at 0x10016d54, which is not aligned (persist.UserData[21] and [22]; a `double` takes an even element and the next)
#include "KMotionDef.h"

main()
{
    double lengths[3] = {42.5, 61.25, 80.0};
    int i;

    for (i = 0; i < 3; i++)
        *(double *)&persist.UserData[20 + i] = lengths[i];
    for (i = 0; i < 3; i++)
        printf("length %d: %.2f\n", i, *(double *)&persist.UserData[20 + i]);
}
