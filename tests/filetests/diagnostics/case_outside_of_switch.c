//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int tool = persist.UserData[10];

    switch (tool)
    {
        case 1: SetBit(46); break;
    }
        case 2: SetBit(47); break;
}
