//@ args: check
//@ says: warning[lost-fraction]: the fraction of 0.25 is lost in a value of type `int`
//@ says: fraction_in_an_int.c:8:17
#include "KMotionDef.h"

main()
{
    int delay = 0.25;
    Delay_sec(delay);
}
