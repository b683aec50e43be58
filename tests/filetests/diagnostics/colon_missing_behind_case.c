//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    switch (persist.UserData[10])
    {
        case 1
            SetBit(46);
            break;
    }
}
