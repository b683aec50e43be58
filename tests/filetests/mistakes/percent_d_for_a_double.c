//@ args: check
//@ says: warning[format]: `%d` needs an `int`
//@ says: percent_d_for_a_double.c:8:20
#include "KMotionDef.h"

main()
{
    printf("%d\n", ch0->Dest);
}
