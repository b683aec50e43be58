//@ prints: 5
#include "KMotionDef.h"
#define X

main()
{
#ifndef X
#else X is defined
    printf("5\n");
#endif X
}
//@ cycles: 783
