//@ exit: 3
//@ says: thread 1 stopped at division_by_a_variable_that_is_zero.c:8:5 in `main`: integer division by zero
#include "KMotionDef.h"

main()
{
    int n = persist.UserData[9];
    printf("%d\n", 100 / n);
}
