//@ args: check
//@ says: warning[text-comparison]: two addresses are compared, not two texts
//@ says: text_compared_with_two_equals_signs.c:10:9
#include "KMotionDef.h"

char command[20] = "GO";

main()
{
    if (command == "GO") printf("go\n");
}
