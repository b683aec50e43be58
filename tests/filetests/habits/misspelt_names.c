// Letter case and typing slips, each with the name that was meant.
//@ exit: 1
//@ says: did you mean `ReadBit`?
//@ says: did you mean `T0`?
//@ says: did you mean `Dest`?
#include "KMotionDef.h"

main()
{
    double T0 = Time_sec();
    while (!Readbit(46)) //~ error: Readbit
    {
        if (Time_sec() > t0 + 5) break; //~ error: t0
    }
    ch0->Dst = 0; //~ error: Dst
}
