//@ args: check
//@ says: warning[assignment-condition]: an assignment is used as a condition
//@ says: not_equal_written_backwards.c:9:12
//@ says: write `!=` or `==` to compare, or a second pair of parentheses if this is meant
#include "KMotionDef.h"
main()
{
    int n = 3;
    while (n =! 5) n++;
}
