//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int spindle = 3;

    switch (persist.UserData[10])
    {
        case spindle:
            SetBit(46);
    }
}
