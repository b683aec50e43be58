//@ exit: 1
#include "KMotionDef.h"

int a, list[3];

main()
{
    a + 1 = 5; //~ error: cannot be assigned to
    list = 0; //~ error: cannot be assigned to
    (char)a = 5; //~ error: cannot be assigned to
    if (ReadBit(46) = 1) a = 2; //~ error: the result of a function cannot be assigned to
    5++; //~ error: cannot be assigned to
}
