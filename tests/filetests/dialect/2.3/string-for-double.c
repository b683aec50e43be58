//@ exit: 1
#include "KMotionDef.h"

main()
{
    Delay_sec("1.5"); //~ error: cannot convert
}
