//@ args: check
//@ says: warning[constant-comparison]: this comparison is always false
//@ says: char_compared_with_200.c:9:9
#include "KMotionDef.h"

main()
{
    char level = persist.UserData[3];
    if (level == 200) printf("full\n");
}
