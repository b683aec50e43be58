//@ args: check
//@ says: warning[shadow]: this `touched` shadows the global `touched`
//@ says: result_in_a_local_that_hides_the_global.c:14:12
//@ says: nothing sets it: it stays 0
#include "KMotionDef.h"

double touched;

void Probe(void)
{
    Jog(2, -500);
    while (ReadBit(139)) WaitNextTimeSlice();
    // `main` reads the global.
    double touched = chan[2].Dest;
    Jog(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
    printf("touched at %.0f\n", touched);
}

main()
{
    Probe();
    Move(2, touched + 100);
    while (!CheckDone(2)) WaitNextTimeSlice();
}
