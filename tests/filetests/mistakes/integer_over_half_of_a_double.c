//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[61]` is the second half of a `double`
//@ says: integer_over_half_of_a_double.c:9:5
#include "KMotionDef.h"

main()
{
    *(double *)&persist.UserData[60] = ch0->Dest / 157.48;
    persist.UserData[61] = 1;
}
