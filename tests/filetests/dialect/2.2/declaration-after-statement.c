//@ prints: 5 6
#include "KMotionDef.h"

main()
{
    int a = 5;
    a++;
    int b = a;
    a--;
    double c = b;
    printf("%d %.0f\n", a, c);
}
//@ cycles: 5278
