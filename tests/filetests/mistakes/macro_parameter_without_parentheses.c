//@ args: check
//@ says: warning[macro-parentheses]: the `*` in the macro `MM` is computed before the `+` in its argument
//@ says: macro_parameter_without_parentheses.c:11:13
#include "KMotionDef.h"

#define MM(x) x * 200

main()
{
    double edge = 10, width = 5;
    Move(0, MM(edge + width));
}
