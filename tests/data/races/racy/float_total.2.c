#include "KMotionDef.h"

main()
{
    float *meters = (float *)persist.UserData + 70;
    int i;

    for (i = 0; i < 2000; i++)
        *meters -= 0.25f;  // <-
}
