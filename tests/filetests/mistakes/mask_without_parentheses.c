//@ args: check
//@ says: warning[precedence]: `==` is computed before `&`
//@ says: mask_without_parentheses.c:12:17
//@ says: write the `&` in parentheses: `(a & b) == c`
#include "KMotionDef.h"

main()
{
    int flags = persist.UserData[10], other = persist.UserData[11];

    while (!CheckDone(0)) WaitNextTimeSlice();
    if (flags & 4 == 4) printf("bit 2\n");
    if (flags == 3 | other == 4) printf("either\n");
    if (flags & 1 == 1) printf("odd\n");
}
