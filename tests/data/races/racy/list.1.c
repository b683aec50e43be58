// race-record:
#include "KMotionDef.h"

#define COUNT persist.UserData[10]
#define ITEM(i) persist.UserData[11 + (i)]

// Takes the first job out of the list: the others move up.
void drop(void)
{
    int i;

    for (i = 1; i < COUNT; i++)
        ITEM(i - 1) = ITEM(i);  // <-
    COUNT--;
}

main()
{
    int i, k;

    for (k = 0; k < 200; k++)
    {
        for (i = 0; i < 12; i++)
        {
            ITEM(i) = 100 * k + i;  // <-
            COUNT = i + 1;
        }
        for (i = 0; i < 12; i++)
            drop();
    }
    persist.UserData[30] = 1;
}
