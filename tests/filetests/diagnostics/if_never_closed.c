//@ exit: 1
//@ args: check
//@ snapshot
#include "KMotionDef.h"

#ifdef TWO_AXES
#define AXES 2

main()
{
    EnableAxis(0);
}
