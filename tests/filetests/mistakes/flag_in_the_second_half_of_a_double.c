//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[11]` is the second half of a `double`
//@ says: flag_in_the_second_half_of_a_double.c:12:9
#include "KMotionDef.h"

#define HOMED 11
#define LASTPOS 10
main()
{
    persist.UserData[HOMED] = 0;
    *(double *)&persist.UserData[LASTPOS] = ch0->Dest;
    if (persist.UserData[HOMED])
        Move(0, 9000);
}
