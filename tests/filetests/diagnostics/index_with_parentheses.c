//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int table[10];

main()
{
    table(3) = 7;
    persist.UserData(5) = 1;
}
