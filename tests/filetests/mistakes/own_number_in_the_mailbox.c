//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[100]` is the PC's mailbox
//@ says: own_number_in_the_mailbox.c:11:5
//@ says: use an element outside 100 to 107 for a number of your own
#include "KMotionDef.h"

#define TOOL 100

main()
{
    persist.UserData[TOOL] = 3;
    printf("tool %d\n", persist.UserData[TOOL]);
}
