//@ exit: 1
#include "KMotionDef.h"

main()
{
    asm("nop"); //~ error: inline assembly
}
