// cc67: part of start.c
#include "KMotionDef.h"

main()
{
    int speed;

    WaitNextTimeSlice();
    speed = persist.UserData[35];
    persist.UserData[36] = speed ? speed : -1;
}
