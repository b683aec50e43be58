//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define SPEED = 1000

main()
{
    Jog(0, SPEED);
}
