//@ args: check
//@ says: warning[loop-condition]: `x` steps over the end of the loop
//@ says: loop_that_steps_over_its_end.c:9:17
#include "KMotionDef.h"

main()
{
    double x;
    for (x = 0; x != 1; x += 0.1) ch0->Dest = x;
}
