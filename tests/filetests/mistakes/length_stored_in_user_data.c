//@ args: check
//@ says: warning[lost-fraction]: the fraction is lost in an element of `persist.UserData`, an `int`
//@ says: length_stored_in_user_data.c:9:28
#include "KMotionDef.h"

main()
{
    double len = (ch0->Position - 1000) / 157.48;
    persist.UserData[40] = len;
}
