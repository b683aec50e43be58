//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    Delay_sec("0.5");
}
