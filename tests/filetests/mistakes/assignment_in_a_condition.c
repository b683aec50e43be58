//@ args: check
//@ says: warning[assignment-condition]: an assignment is used as a condition
//@ says: assignment_in_a_condition.c:9:9
#include "KMotionDef.h"

main()
{
    int bit = 0;
    if (bit = 1) printf("on\n");
}
