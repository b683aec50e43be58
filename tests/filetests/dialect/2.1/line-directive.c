//@ prints: 100 part.c
#include "KMotionDef.h"
#

main()
{
#line 100 "part.c"
    printf("%d %s\n", __LINE__, __FILE__);
}
//@ cycles: 5494
