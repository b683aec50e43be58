//@ args: check
//@ says: warning[format]: the board prints 40 bits, of this argument and the next: `%ld`
//@ says: long_printed_with_ld.c:9:12
#include "KMotionDef.h"

main()
{
    long count = 5;
    printf("%ld of %d\n", count, 7);
}
