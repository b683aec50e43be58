//@ args: check
//@ says: warning[user-data-index]: `persist.UserData` has no element 200
//@ says: user_data_200.c:8:22
#include "KMotionDef.h"

main()
{
    persist.UserData[200] = 1;
}
