//@ args: check
//@ says: warning[user-data-index]: `persist.UserData` has no element 200
//@ says: all_user_data_and_one_more.c:9:32
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i <= 200; i++) persist.UserData[i] = 0;
}
