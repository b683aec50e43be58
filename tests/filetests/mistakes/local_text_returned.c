//@ args: check
//@ says: warning[returned-local]: the address of `text` is returned, which ends with the function
//@ says: local_text_returned.c:10:12
#include "KMotionDef.h"

char *Name(int axis)
{
    char text[10];
    sprintf(text, "axis %d", axis);
    return text;
}

main()
{
    printf("%s\n", Name(3));
}
