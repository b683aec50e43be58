//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    Jog(0, –1000);
}
