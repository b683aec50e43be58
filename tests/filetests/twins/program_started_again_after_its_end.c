//@ args: --stim parts/again.stim --for 1
//@ prints: once
//@ prints: once
#include "KMotionDef.h"

main()
{
    printf("once\n");
}
