//@ prints: 5
#include "KMotionDef.h"

main()
{
    int a = 5; // files are in C:\KMotion\
//~^ note: backslash
    printf("%d\n", a);
}
//@ cycles: 2481
