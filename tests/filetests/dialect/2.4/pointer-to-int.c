//@ prints: 1 1
#include "KMotionDef.h"

int value;

main()
{
    int a, b;
    a = &value; //~ int-pointer
    b = main; //~ int-pointer
    printf("%d %d\n", a != 0, b != 0);
}
//@ cycles: 4553
