//@ args: check
//@ says: warning[text-overflow]: `memset` may store 100 bytes in `values`, which has 40
//@ says: block_larger_than_its_array.c:10:5
#include <string.h>
#include "KMotionDef.h"

main()
{
    int values[10];
    memset(values, 0, 100);
    printf("%d\n", values[9]);
}
