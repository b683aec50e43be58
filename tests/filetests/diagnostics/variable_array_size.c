//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int n = persist.UserData[0];
    double samples[n];

    samples[0] = 1;
}
