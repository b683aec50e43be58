#include "KMotionDef.h"

main()
{
    while (!persist.UserData[12])
        persist.UserData[13] = persist.UserData[10] + persist.UserData[11];
}
