//@ args: check
//@ says: warning[unused-value]: this moves the pointer; the value that it points to stays the same
//@ says: counter_reached_by_a_pointer.c:8:5
#include "KMotionDef.h"

void Count(int *parts)
{
    *parts++;
}

main()
{
    Count(&persist.UserData[20]);
}
