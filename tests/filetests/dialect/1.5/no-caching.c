//@ args: run 2:parts/store_later.c
//@ prints: seen
#include "KMotionDef.h"

main()
{
    persist.UserData[3] = 0;
    persist.UserData[4] = 1;
    while (persist.UserData[3] == 0) ;
    printf("seen\n");
}
