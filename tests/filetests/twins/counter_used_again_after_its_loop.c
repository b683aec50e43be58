//@ prints: 0 0
//@ prints: 0 1
//@ prints: 1 0
//@ prints: 1 1
//@ prints: 0
//@ prints: 1
#include "KMotionDef.h"

main()
{
    int i, k;
    for (i = 0; i < 2; i++)
        for (k = 0; k < 2; k++) printf("%d %d\n", i, k);
    for (i = 0; i < 2; i++) printf("%d\n", i);
}
