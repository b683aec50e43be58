//@ args: check
//@ says: warning[empty-body]: `for` with an empty body
//@ says: semicolon_after_for.c:9:37
#include "KMotionDef.h"

main()
{
    int axis;
    for (axis = 0; axis < 3; axis++);
        EnableAxisDest(axis, 0);
}
