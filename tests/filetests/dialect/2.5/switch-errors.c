//@ exit: 1
#include "KMotionDef.h"

main()
{
    int n = 3;
    switch (n) {
    case 1: break;
    case 1: break; //~ error: case 1
    case 2.5: break; //~ error: integer constant
    case n: break; //~ error: constant
    default: break;
    default: break; //~ error: default
    }
}
