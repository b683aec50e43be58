//@ exit: 3
//@ says: division by zero
#include "KMotionDef.h"

unsigned zero;

main()
{
    persist.UserData[0] = 5 % zero;
}
//@ cycles: 22
