//@ args: check
//@ says: warning[constant-comparison]: this comparison is always false
//@ says: bit_compared_with_5.c:8:9
#include "KMotionDef.h"

main()
{
    if (ReadBit(136) == 5) printf("on\n");
}
