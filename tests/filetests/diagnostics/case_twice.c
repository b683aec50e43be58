//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define OPEN_DRAWBAR 3

main()
{
    switch (persist.UserData[10])
    {
        case OPEN_DRAWBAR:
            SetBit(46);
            break;
        case 3:
            ClearBit(46);
            break;
    }
}
