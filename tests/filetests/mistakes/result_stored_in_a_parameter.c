//@ args: check
//@ says: warning[parameter-copy]: `edge` is a copy of the caller's value: what is stored in it stays in `Probe`
//@ says: result_stored_in_a_parameter.c:14:5
//@ says: take the address, `double *edge`, store in `*edge`, and call with `&` before the variable
#include "KMotionDef.h"

void Probe(double edge)
{
    Jog(2, -500);
    while (ReadBit(139)) WaitNextTimeSlice();
    Jog(2, 0);
    while (!CheckDone(2)) WaitNextTimeSlice();
    // The caller's variable stays as it is.
    edge = chan[2].Dest;
}

main()
{
    double found = 0;

    Probe(found);
    printf("edge at %.0f\n", found);
}
