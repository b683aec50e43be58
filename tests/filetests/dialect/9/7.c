//@ args: run 2:parts/answers.c
//@ prints: both seen
#include "KMotionDef.h"

double x;

main()
{
    persist.UserData[60] = (int)&x;
    while (x == 0.0) ;
    while (persist.UserData[3] == 0) ;
    printf("both seen\n");
}
