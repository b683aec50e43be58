//@ args: check
//@ says: warning[integer-division]: this division of integers drops the fraction before the result becomes a `double`
//@ says: integers_divided_into_a_double.c:13:12
#include "KMotionDef.h"

int done, total;

main()
{
    double part;
    done = persist.UserData[10];
    total = persist.UserData[11];
    part = done / total;
    printf("%.0f %%\n", part * 100);
}
