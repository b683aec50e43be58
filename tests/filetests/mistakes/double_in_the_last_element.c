//@ args: check
//@ says: warning[user-data-alignment]: a `double` at an odd index of `persist.UserData` is not aligned
//@ says: use index 198
#include "KMotionDef.h"
main()
{
    *(double *)&persist.UserData[199] = 1.5;
}
