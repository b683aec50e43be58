//@ exit: 1
//@ says: write `"`
#include "KMotionDef.h"

main()
{
    printf(“hello”); //~ error: “
}
