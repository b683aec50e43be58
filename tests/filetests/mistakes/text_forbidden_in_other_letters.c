//@ args: --stim parts/no_error.stim
//@ prints: ERROR: no oil
//@ says: "ERROR" is printed, in other letters: upper and lower case count
//@ says: no_error.stim:1:1
#include "KMotionDef.h"

main()
{
    printf("ERROR: no oil\n");
}
