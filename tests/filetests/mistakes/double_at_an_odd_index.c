//@ exit: 3
//@ says: warning[user-data-alignment]: a `double` at an odd index of `persist.UserData` is not aligned
//@ says:    ┌─ double_at_an_odd_index.c:14:17
//@ says:    │
//@ says: 14 │     double *d = (double *)&persist.UserData[11];
//@ says:    │                 ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ index 11: the board would load a wrong value
//@ says:    │
//@ says:    = help: use index 10 or 12
//@ says: thread 1 stopped at double_at_an_odd_index.c:16:5 in `main`: read of 8 bytes at 0x10016d2c, which is not aligned
#include "KMotionDef.h"

main()
{
    double *d = (double *)&persist.UserData[11];
    int i = persist.UserData[0];
    printf("%f\n", d[i]);
}
