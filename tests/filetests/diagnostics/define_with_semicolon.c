//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

#define LAMP 46;

main()
{
    SetBit(LAMP);
}
