//@ args: check
//@ says: warning[empty-body]: `for` with an empty body
//@ says: semicolon_after_for_on_one_line.c:9:28
#include "KMotionDef.h"

main()
{
    int i;
    for (i = 0; i < 3; i++); EnableAxis(i);
}
