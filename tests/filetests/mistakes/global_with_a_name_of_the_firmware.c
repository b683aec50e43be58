//@ args: check
//@ says: warning[redeclared]: the firmware already has a `s`
//@ says: global_with_a_name_of_the_firmware.c:6:8
#include "KMotionDef.h"

double s;

main()
{
    s = 1;
    printf("%f\n", s);
}
