//@ prints: text 1.500000
//@ prints: 5 1.500000
//@ snapshot
#include "KMotionDef.h"

main()
{
    printf("%s %f\n", "text", 1.5);
    printf("%d %f\n", 5, 2);
}
//@ cycles: 14046
