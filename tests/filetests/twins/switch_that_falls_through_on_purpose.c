//@ args: check
#include "KMotionDef.h"

main()
{
    switch (persist.UserData[5])
    {
    case 2:
        SetBit(47);
        // fall through
    case 1:
        SetBit(46);
        break;
    case 3:
        if (ReadBit(46)) break;
        else return;
    case 4:
        { ClearBit(46); break; }
    case 5:
        for (;;) WaitNextTimeSlice();
    default:
        ClearBit(47);
    }
}
