//@ args: --machine parts/home.toml --for 0.5
//@ says: thread 1 at output_mode_forgotten_with_a_switch.c:11:5 in `main`: Jog: axis 0 drives nothing, its OutputMode is NO_OUTPUT_MODE: what the machine file connects to it stays as it is (is a program that sets the axes up to run first?)
//@ says: at the end, after 0.500 s of board time:
//@ says:   thread 1 at output_mode_forgotten_with_a_switch.c:12:12 in `main` waits for bit 12, which is 0: its switch is 1 at ≤ -200, axis 0 is at 3000, since 0.000 s
//@ says:   axis 0 (X): enabled, Dest -448.06, Position 0, moves at -1000 units/s: its OutputMode is NO_OUTPUT_MODE, so it drives nothing
#include "KMotionDef.h"

main()
{
    EnableAxis(0);
    Jog(0, -1000);
    while (!ReadBit(12)) ;
}
