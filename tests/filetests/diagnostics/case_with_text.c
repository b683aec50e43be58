//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    char *mode = "auto";

    switch (mode)
    {
        case "auto":
            SetBit(46);
            break;
    }
}
