//@ args: check
//@ says: warning[reversed-operator]: `=-` assigns a value with a sign
//@ says: minus_after_the_equals_sign.c:9:13
#include "KMotionDef.h"

main()
{
    double target = 100.0;
    target =- 0.5;
    MoveRel(0, target);
}
