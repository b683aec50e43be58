//@ args: check
//@ says: warning[narrow-type]: `Position` does not fit in a `short`
//@ says: position_in_a_short.c:8:19
#include "KMotionDef.h"

main()
{
    short start = ch0->Position;
    printf("%d\n", start);
}
