#include "KMotionDef.h"

main()
{
    int wrong = 0;

    while (!persist.UserData[88])
    {
        if (persist.UserData[85] + persist.UserData[86] > 7 * persist.UserData[87] / 5 + 20)  // <-
            wrong++;
    }
    persist.UserData[89] = wrong;
}
