//@ args: check
//@ says: warning[macro-parentheses]: the `*` beside the macro `TRAVEL` is computed before the `+` in it
//@ says: macro_body_without_parentheses.c:10:17
#include "KMotionDef.h"

#define TRAVEL 1000 + 500

main()
{
    Move(0, 2 * TRAVEL);
}
