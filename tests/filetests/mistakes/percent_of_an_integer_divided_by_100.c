//@ args: check
//@ says: warning[integer-division]: this division of integers drops the fraction before the result becomes a `double`
//@ says: percent_of_an_integer_divided_by_100.c:9:12
#include "KMotionDef.h"

main()
{
    int Percent = persist.UserData[10];
    Jog(3, Percent / 100 * 20000.0);
}
