//@ args: check
//@ says: warning[loop-condition]: this loop ends only if `Position` is exactly this number
//@ says: wait_for_an_exact_position.c:9:12
#include "KMotionDef.h"

main()
{
    Move(0, 1000);
    while (ch0->Position != 1000) ;
}
