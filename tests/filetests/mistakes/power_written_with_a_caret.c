//@ args: check
//@ says: warning[power]: `^` is exclusive or, not a power
//@ says: power_written_with_a_caret.c:8:17
#include "KMotionDef.h"

main()
{
    int steps = 2 ^ 10;
    printf("%d\n", steps);
}
