// order-early: persist.UserData[21]
#include "KMotionDef.h"

#define ORDER persist.UserData[20]
#define TOOL persist.UserData[21]

main()
{
    int i;

    for (i = 1; i <= 40; i++)
    {
        ORDER = 1;  // <-
        TOOL = i;   // <-
        while (ORDER)
            ;
    }
    ORDER = -1;
}
