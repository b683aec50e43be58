//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

bool homed = false;

main()
{
    homed = true;
    if (homed) printf("homed\n");
}
