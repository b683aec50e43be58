//@ prints: 5
#include "KMotionDef.h"

main()
{
    int x = 5;
    x == 6; //~ unused-value
    x + 1; //~ unused-value
    DisableAxis; //~ unused-value
    printf("%d\n", x);
}
//@ cycles: 2481
