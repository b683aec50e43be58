//@ args: check
//@ says: warning[unreachable-code]: this statement is never executed
//@ says: this `break` leaves the `switch`, not the loop
//@ says: break_of_a_switch_in_an_endless_loop.c:22:5
#include "KMotionDef.h"

main()
{
    while (1)
    {
        switch (ReadBit(136) + 2 * ReadBit(137))
        {
        case 1:
            SetBit(46);
            break;
        case 2:
            ClearBit(46);
            break;
        }
        Delay_sec(0.05);
    }
    printf("stopped\n");
}
