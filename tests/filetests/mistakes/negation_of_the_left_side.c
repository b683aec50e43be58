//@ args: check
//@ says: warning[precedence]: `==` compares a 0 or 1 here
//@ says: negation_of_the_left_side.c:7:9
#include "KMotionDef.h"
main()
{
    if (!persist.UserData[3] == 5) SetBit(47);
}
