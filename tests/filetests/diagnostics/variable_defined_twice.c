//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int speed = 100;
int speed = 200;

main()
{
    Jog(0, speed);
}
