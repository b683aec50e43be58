//@ args: check
//@ says: warning[format]: `%\n` is not a conversion
//@ says: write `%%` for a percent sign
#include "KMotionDef.h"
main()
{
    printf("100%\n");
}
