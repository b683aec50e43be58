//@ args: check
//@ says: warning[unsequenced]: one variable is changed twice in an expression
//@ says: counted_into_itself.c:9:22
#include "KMotionDef.h"

main()
{
    int part = 0;
    while (part < 6) part = part++;
    printf("%d parts\n", part);
}
