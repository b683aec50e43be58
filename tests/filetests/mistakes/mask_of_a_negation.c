//@ args: check
//@ says: warning[precedence]: `!` is computed before `&`
//@ says: mask_of_a_negation.c:9:9
#include "KMotionDef.h"

main()
{
    int mask = persist.UserData[5];
    if (!mask & 0x02) SetBit(47);
}
