//@ args: check
//@ says: warning[user-data-alignment]: a `double` at an odd index of `persist.UserData` is not aligned
//@ says: double_stored_at_an_odd_index.c:8:6
#include "KMotionDef.h"

main()
{
    *(double *)&persist.UserData[11] = 1.5;
}
