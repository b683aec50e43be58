//@ args: check
//@ says: warning[macro-parentheses]: the `(…)` in the macro `COUNTS` is computed before the `*` in its argument
//@ says: cast_in_a_macro_without_parentheses.c:11:20
#include "KMotionDef.h"

#define COUNTS(x) (int)x

main()
{
    double mm = 2.5;
    printf("%f\n", COUNTS(mm * 157.48));
}
