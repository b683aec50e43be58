//@ args: check
//@ says: warning[logical-constant]: `||` only tests whether 4 is nonzero
//@ says: second_comparison_without_its_left_side.c:9:22
#include "KMotionDef.h"

main()
{
    int tool = persist.UserData[10];
    if (tool == 3 || 4) printf("a drill\n");
}
