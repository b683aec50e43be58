//@ prints: 2.500000 7 3 5
#include "KMotionDef.h"

int yes = 7, no;

main()
{
    int i, j;
    double d = no ? 1 : 2.5;
    for (i = 0, j = 5; i < 3; i++, j++) ;
    j = (i++, i - 1);
    printf("%f %d %d %d\n", d, yes ?: 9, j, no ?: 5);
}
//@ cycles: 11194
