//@ args: --machine parts/home.toml --for 0.5
//@ says: thread 1 at output_mode_forgotten_with_a_switch.c:11:5 in `main`: Jog: axis 0 drives nothing because its OutputMode is NO_OUTPUT_MODE, so the machine does not move (should an init program run first?)
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at output_mode_forgotten_with_a_switch.c:12:12 in `main` has waited since 0.000 s for bit 12 (now 0): its switch is 1 at ≤ -200, and axis 0 is at 3000
//@ says:   axis 0 (X): enabled, Dest -448.06, Position 0, moves at -1000 units/s: its OutputMode is NO_OUTPUT_MODE, so it drives nothing
#include "KMotionDef.h"

main()
{
    EnableAxis(0);
    Jog(0, -1000);
    while (!ReadBit(12)) ;
}
