//@ args: check
//@ says: warning[long-string]: the string is longer than the array
//@ says: text_one_character_too_long.c:8:20
//@ says: the last character is dropped
#include "KMotionDef.h"
main()
{
    char name[3] = "XYZA";
    printf("%.3s\n", name);
}
