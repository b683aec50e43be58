//@ prints: -1
#include "KMotionDef.h"

main()
{
    int axis;
    for (axis = 7; axis >= 0; axis--) DisableAxis(axis);
    printf("%d\n", axis);
}
