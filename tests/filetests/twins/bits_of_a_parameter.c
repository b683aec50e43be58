//@ prints: 3fc00000 0
#include "KMotionDef.h"

int Bits(float f)
{
    return *(int *)&f;
}

int Low(double d)
{
    return *(int *)&d;
}

main()
{
    printf("%x %x\n", Bits(1.5f), Low(0.5));
}
