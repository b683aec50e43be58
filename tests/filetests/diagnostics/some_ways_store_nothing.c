//@ args: check -Wno-fall-through -Wall
//@ snapshot
#include "KMotionDef.h"

main()
{
    int a, b, c, d, never;
    if (ReadBit(1)) a = 1;
    while (ReadBit(2)) b = 1;
    switch (ReadBit(3))
    {
    case 0: c = 1;
    case 1: d = 2;
    }
    printf("%d %d %d %d %d\n", a, b, c, d, never);
}
