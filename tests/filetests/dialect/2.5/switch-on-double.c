//@ prints: two
#include "KMotionDef.h"

main()
{
    double d = 2.9;
    switch (d) { //~ extension
    case 2: printf("two\n"); break;
    default: printf("wrong\n");
    }
}
//@ cycles: 1157
