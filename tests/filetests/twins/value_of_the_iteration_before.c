//@ prints: 1
#include "KMotionDef.h"

main()
{
    int i, last, changes = 0;
    for (i = 0; i < 3; i++)
    {
        if (i > 0 && last != i / 2) changes = changes + 1;
        last = i / 2;
    }
    printf("%d\n", changes);
}
