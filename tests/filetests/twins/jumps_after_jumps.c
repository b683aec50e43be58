//@ prints: 100 1000
#include "KMotionDef.h"

int speed(int mode)
{
    switch (mode)
    {
    case 0:
        return 100;
        break;
    default:
        goto fast;
    }
    return 0;
fast:
    return 1000;
}

main()
{
    printf("%d %d\n", speed(0), speed(1));
}
