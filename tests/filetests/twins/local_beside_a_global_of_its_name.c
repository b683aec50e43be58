//@ args: check
#include "KMotionDef.h"

double touched;
int axis = 0;

double Probe(void)
{
    double touched = chan[2].Dest;
    int axis = 2;
    Jog(axis, 0);
    return touched;
}

main()
{
    touched = Probe();
    Move(axis, touched + 100);
    while (!CheckDone(axis)) WaitNextTimeSlice();
}
