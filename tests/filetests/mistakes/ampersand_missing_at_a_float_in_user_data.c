//@ args: check
//@ says: warning[user-data-pointer]: the value of an element of `persist.UserData` is used as an address
//@ says: ampersand_missing_at_a_float_in_user_data.c:8:29
#include "KMotionDef.h"

main()
{
    double feed = *(float *)persist.UserData[10];
    MoveAtVel(0, 100, feed);
}
