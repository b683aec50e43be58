//@ args: check
//@ says: warning[uninitialized]: `total` is read before it has a value
//@ says: total_without_a_start.c:11:17
#include "KMotionDef.h"

main()
{
    double total, last = 0;
    for (;;)
    {
        total = total + 10 * (ch3->Position - last);
        last = ch3->Position;
        MoveExp(0, total, 0.05);
        Delay_sec(0.05);
    }
}
