//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

struct point
{
    double x, y;
}

main()
{
    struct point here;
    here.x = ch0->Position;
}
