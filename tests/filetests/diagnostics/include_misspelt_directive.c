//@ exit: 1
//@ snapshot
#inlcude "KMotionDef.h"

main()
{
    SetBit(46);
}
