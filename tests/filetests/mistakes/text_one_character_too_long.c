//@ args: check
//@ says: warning[long-string]: the string is longer than the array
//@ says: the last character is dropped
#include "KMotionDef.h"
main()
{
    char name[3] = "XYZA";
    printf("%.3s\n", name);
}
