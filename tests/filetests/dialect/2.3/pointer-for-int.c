//@ prints: 1 5
#include "KMotionDef.h"

int value = 5;
int number(int n) { return n != 0; }
int *pointer(int *p) { return p; }

main()
{
    int n = number(&value); //~ int-pointer
    int *p = pointer((int)&value); //~ int-pointer
    printf("%d %d\n", n, *p);
}
//@ cycles: 4552
