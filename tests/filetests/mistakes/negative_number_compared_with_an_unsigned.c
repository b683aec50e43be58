//@ args: check
//@ says: warning[negative-comparison]: `error` can be negative, and is compared with an unsigned value
//@ says: negative_number_compared_with_an_unsigned.c:10:9
#include "KMotionDef.h"

main()
{
    unsigned limit = persist.UserData[10];
    int error = ReadADC(0) - 2048;
    if (error < limit) printf("small\n");
}
