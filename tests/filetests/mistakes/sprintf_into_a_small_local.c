//@ args: check
//@ says: warning[text-overflow]: `sprintf` stores at least 18 bytes in `text`, which has 8
//@ says: sprintf_into_a_small_local.c:9:5
#include "KMotionDef.h"

main()
{
    char text[8];
    sprintf(text, "position %f", ch0->Dest);
    printf("%s\n", text);
}
