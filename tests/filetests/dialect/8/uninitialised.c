//@ prints: 5
#include "KMotionDef.h"

main()
{
    int sure, maybe, sum;
    if (persist.UserData[5]) maybe = 3;
    sum = persist.UserData[5] ? maybe : 5;
    persist.UserData[0] = sure; //~ uninitialized: sure
    printf("%d\n", sum);
}
//@ cycles: 2486
