//@ args: check
//@ says: warning[array-bounds]: `table` has no element 4
//@ says: element_beyond_an_array.c:10:5
#include "KMotionDef.h"

int table[4];

main()
{
    table[4] = 1;
}
