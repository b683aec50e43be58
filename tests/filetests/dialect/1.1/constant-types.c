//@ prints: 0 0 1 4 8 1
#include "KMotionDef.h"

_Static_assert(!(-1 < 2147483648), "2147483648 is unsigned");
_Static_assert(-2147483648 > 0, "and stays so behind a minus");
_Static_assert(-1 < 2147483647, "2147483647 is not");
_Static_assert(sizeof 4294967295 == 4 && sizeof 4294967296 == 8, "above 32 bits: long long");

main()
{
    int minus = -1;
    printf("%d %d %d %d %d %d\n", minus < 2147483648, minus < 0x80000000, -2147483648 > 0, //~ negative-comparison
    //~^ negative-comparison
           sizeof 0xffffffff, sizeof 0x100000000, 4294967296 > 0);
}
//@ cycles: 12828
