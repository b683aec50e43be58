//@ prints: 5
#include "KMotionDef.h"
#define FIVE 5;

main()
{
    int a = FIVE
    printf("%d\n", a);
}
//@ cycles: 2481
