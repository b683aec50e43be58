//@ exit: 1
//@ snapshot
#include "KMotionDef.h"
#include "helper_by_itself.c"

int Debounce = 5;

main()
{
    SetBit(Debounce);
}
