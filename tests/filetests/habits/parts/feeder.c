// Answers once it is asked.
#include "KMotionDef.h"

main()
{
    while (!persist.UserData[91]) ;
    Delay_sec(0.02);
    persist.UserData[90] = 1;
    Delay_sec(0.02);
    *(float *)&persist.UserData[92] = 25.4;
}
