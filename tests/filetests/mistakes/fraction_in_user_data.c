//@ args: check
//@ says: warning[lost-fraction]: the fraction of 2.5 is lost in a value of type `int`
//@ says: fraction_in_user_data.c:8:28
#include "KMotionDef.h"

main()
{
    persist.UserData[10] = 2.5;
}
