//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    persist[5] = 1;
    UserData[6] = 2;
}
