//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int i;

    for (i = 0, i < 8, i++)
        DisableAxis(i);
}
