//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int place[16];

    if (setjmp(place)) return;
    longjmp(place, 1);
}
