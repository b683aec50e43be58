//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

struct point { double x, y; };

main()
{
    point here;

    here.x = 1;
}
