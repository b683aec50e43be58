//@ prints: 1 1
#include "KMotionDef.h"

int address = 0x80050000;

main()
{
    int *p = 0, *q;
    q = address; //~ int-pointer
    printf("%d %d\n", p == 0, q != 0);
}
//@ cycles: 4552
