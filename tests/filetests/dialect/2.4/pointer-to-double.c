//@ exit: 1
#include "KMotionDef.h"

main()
{
    double d;
    d = &persist.UserData[0]; //~ error: cannot convert
}
