//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    printf("homing axis %d\n, 3);
    Jog(0, 100);
}
