//@ args: check
//@ says: warning[format]: `%\n` is not a conversion
//@ says: percent_sign_alone.c:8:12
//@ says: write `%%` for a percent sign
#include "KMotionDef.h"
main()
{
    printf("100%\n");
}
