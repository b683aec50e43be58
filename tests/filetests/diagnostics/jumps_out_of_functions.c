//@ exit: 1
//@ snapshot
#include "KMotionDef.h"
#include <setjmp.h>

jmp_buf place;

main()
{
    if (setjmp(place)) return;
    longjmp(place, 1);
}
