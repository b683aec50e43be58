// Answers in persist.UserData[3] once asked.
#include "KMotionDef.h"

main()
{
    while (persist.UserData[4] == 0) ;
    Delay_sec(0.01);
    persist.UserData[3] = 1;
}
