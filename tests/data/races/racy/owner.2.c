#include "KMotionDef.h"

int *owner = &persist.UserData[30];

int take(void)
{
    if (*owner)
        return 0;
    *owner = 2;  // <-
    return 1;
}

main()
{
    int i = 0;

    while (i < 500)
        if (take())
        {
            i++;
            *owner = 0;
        }
}
