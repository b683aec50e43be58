#include "KMotionDef.h"

void take(int *count)
{
    (*count)--;  // <-
}

main()
{
    int i;

    for (i = 0; i < 3000; i++)
        take(&persist.UserData[90]);
}
