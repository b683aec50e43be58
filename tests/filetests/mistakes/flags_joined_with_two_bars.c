//@ args: check
//@ says: warning[logical-constant]: `||` only tests whether 4 is nonzero
//@ says: flags_joined_with_two_bars.c:11:29
#include "KMotionDef.h"

#define SHOW_BUTTONS 4
#define SHOW_SIGN 48

main()
{
    persist.UserData[102] = SHOW_BUTTONS || SHOW_SIGN;
}
