//@ prints: 432 3456 432
#include "KMotionDef.h"

_Static_assert(sizeof(CHAN) == 432, "axis structure of header 4.34");

main()
{
    printf("%d %d %d\n", sizeof(CHAN), sizeof chan, (char *)ch1 - (char *)ch0);
}
//@ cycles: 8576
