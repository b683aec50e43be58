//@ args: check
//@ says: warning[implicit-declaration]: `floor` is not declared
//@ says: floor_that_the_firmware_lacks.c:8:20
#include "KMotionDef.h"

main()
{
    printf("%f\n", floor(2.7));
}
