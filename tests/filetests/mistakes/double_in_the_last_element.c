//@ args: check
//@ says: warning[user-data-alignment]: a `double` at an odd index of `persist.UserData` is not aligned
//@ says: double_in_the_last_element.c:8
//@ says: use index 198
#include "KMotionDef.h"
main()
{
    *(double *)&persist.UserData[199] = 1.5;
}
