//@ exit: 1
#include "KMotionDef.h"

int a, list[3];

main()
{
    a + 1 = 5; //~ error
    list = 0; //~ error
    (char)a = 5; //~ error
    5++; //~ error
}
