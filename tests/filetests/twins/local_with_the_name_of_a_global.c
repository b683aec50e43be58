//@ prints: 0
//@ prints: 1
#include "KMotionDef.h"

int i = 7;

main()
{
    int i;
    for (i = 0; i < 2; i++) printf("%d\n", i);
}
