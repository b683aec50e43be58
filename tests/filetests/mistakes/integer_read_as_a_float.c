//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[10]` is read as a `float`
//@ says: integer_read_as_a_float.c:10:
//@ says: the bits of the integer 5, which are a number next to 0
#include "KMotionDef.h"

main()
{
    persist.UserData[10] = 5;
    printf("%f\n", *(float *)&persist.UserData[10]);
}
