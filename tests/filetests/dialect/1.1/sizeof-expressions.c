//@ prints: 4 4 4 4 8 4
#include "KMotionDef.h"

_Static_assert(sizeof "abc" == 4 && sizeof 'a' == 4 && sizeof(1 == 1) == 4, "ints");
_Static_assert(sizeof 1.0f == 4 && sizeof 1.0 == 8, "constants");

int parameter(double list[100]) { return sizeof list; } //~ sizeof-pointer

main()
{
    printf("%d %d %d %d %d %d\n", sizeof "abc", sizeof 'a', sizeof(1 == 1), sizeof 1.0f, sizeof 1.0, parameter(0));
}
//@ cycles: 12827
