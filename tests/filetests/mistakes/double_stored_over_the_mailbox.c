//@ args: check
//@ says: warning[user-data-type]: a `double` is stored in `persist.UserData[100]`, which is part of the PC's mailbox
//@ says: double_stored_over_the_mailbox.c:10:5
#include "KMotionDef.h"

#define PUT(n, v) (*(double *)&persist.UserData[(n) * 2] = (v))

main()
{
    PUT(50, 1.0 / 3);
}
