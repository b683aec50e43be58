//@ args: check
//@ snapshot
#include "KMotionDef.h"

main()
{
    double x, y;

    if (sscanf("1 2", "%lf %lf", x, y) == 2) Move(0, x);
}
