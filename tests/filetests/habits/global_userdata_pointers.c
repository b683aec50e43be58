// Pointers into persist.UserData as globals, of another type than what they point to.
//@ prints: 1.500 2.250 3
//@ prints: 3fc00000 3
#include "KMotionDef.h"

float *pFeed = &persist.UserData[30];
float *pSpeed = (float *)&persist.UserData[31];
int *pTool = &persist.UserData[32];
double *pTotal = (double *)&persist.UserData[34];

main()
{
    *pFeed = 1.5;
    *pSpeed = *pFeed * 1.5;
    *pTool = 3;
    *pTotal += *pSpeed;
    printf("%.3f %.3f %d\n", *pFeed, *pSpeed, *pTool);
    printf("%x %d\n", persist.UserData[30], pTool[0]);
}
//@ cycles: 16468
