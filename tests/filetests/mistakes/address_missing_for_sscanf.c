//@ args: check
//@ says: warning[missing-address]: `%d` needs an `int *`
//@ says: address_missing_for_sscanf.c:9:24
#include "KMotionDef.h"

main()
{
    int n = 0;
    sscanf("12", "%d", n);
    printf("%d\n", n);
}
