//@ says: thread 1 at threading_without_a_spindle.c:7:5 in `main`: TrigThreading: no spindle is configured, so nothing will move
//@ says: thread 1 at threading_without_a_spindle.c:7:5 in `main`: TrigThreading: the segment buffer is empty
#include "KMotionDef.h"

main()
{
    TrigThreading(1.0f);
}
