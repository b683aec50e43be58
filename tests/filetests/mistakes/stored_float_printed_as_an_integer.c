//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[20]` is read as an integer
//@ says: stored_float_printed_as_an_integer.c:9:20
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[20] = 2.5f;
    printf("%d\n", persist.UserData[20]);
}
