//@ args: check
//@ says: warning[user-data-type]: a `double` is stored in `persist.UserData[100]`, which is part of the PC's mailbox
//@ says: double_index_50_through_a_pointer.c:10:5
#include "KMotionDef.h"

main()
{
    double *values = (double *)persist.UserData;
    values[10] = ch0->Dest;
    values[50] = ch2->Dest;
}
