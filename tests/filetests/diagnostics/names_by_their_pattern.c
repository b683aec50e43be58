//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    double where;

    if (GetBit(46)) printf("on\n");
    MoveXYZ(1.0, 2.0, 3.0);
    where = Pos(0);
    Kill(2);
    printf("%f\n", where);
}
