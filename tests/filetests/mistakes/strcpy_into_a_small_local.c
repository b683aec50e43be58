//@ args: check
//@ says: warning[text-overflow]: `strcpy` stores at least 12 bytes in `text`, which has 4
//@ says: strcpy_into_a_small_local.c:11:5
#include "KMotionDef.h"

char *strcpy(char *to, const char *from);

main()
{
    char text[4];
    strcpy(text, "hello world");
    printf("%s\n", text);
}
