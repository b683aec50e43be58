//@ args: --stim parts/two_millimetres.stim
//@ exit: 5
//@ says: two_millimetres.stim:1:1: at 0.00018 s persist 20 is 1073741824, expected 2: it holds the float 2, so write `persist 20 = f:2`
//@ says: two_millimetres.stim:2:1: at 0.00018 s persist 21 is 4.203895392974451e-45, expected 3: it holds the integer 3, so write `persist 21 = 3`
//@ says: two_millimetres.stim:3:1: at 0.00018 s persist 22 is 0, expected 2.5: it holds the double 2.5, so write `persist 22 = d:2.5`
#include "KMotionDef.h"

main()
{
    *(float *)&persist.UserData[20] = 2.0;
    persist.UserData[21] = 3;
    *(double *)&persist.UserData[22] = 2.5;
}
