//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[113]` is read as an integer
//@ says: speed_of_the_pc_read_as_an_integer.c:8:17
#include "KMotionDef.h"

main()
{
    float rpm = persist.UserData[113];
    Jog(3, rpm * 10.0);
}
