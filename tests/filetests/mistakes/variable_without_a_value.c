//@ args: check
//@ says: warning[uninitialized]: `n` is read before it has a value
//@ says: variable_without_a_value.c:9:20
#include "KMotionDef.h"

main()
{
    int n;
    printf("%d\n", n);
}
