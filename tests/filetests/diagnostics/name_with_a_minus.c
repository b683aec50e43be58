//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int home-speed = 100;

    Jog(0, home-speed);
}
