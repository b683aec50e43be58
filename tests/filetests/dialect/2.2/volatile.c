//@ prints: 3 5 4
#include "KMotionDef.h"

volatile int shared = 3;

main()
{
    register int a = 1;
    auto int b = 4;
    int before = shared;
    *(int *)&shared = 5;
    printf("%d %d %d\n", before, shared * a, b);
}
//@ cycles: 6623
