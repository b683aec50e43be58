//@ exit: 1
//@ says: did you mean `T0`?
#include "KMotionDef.h"

main()
{
    double T0 = Time_sec();
    while (Time_sec() < t0 + 1) ; //~ error: t0
}
