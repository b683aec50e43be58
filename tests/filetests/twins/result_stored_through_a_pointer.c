//@ args: check
#include "KMotionDef.h"

void Probe(double *edge, double speed)
{
    // A parameter that is changed and used is a local variable with a first value.
    if (speed > 500) speed = 500;
    Jog(2, -speed);
    while (ReadBit(139)) WaitNextTimeSlice();
    Jog(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
    *edge = chan[2].Dest;
}

main()
{
    double found = 0;

    Probe(&found, 1000);
    printf("edge at %.0f\n", found);
}
