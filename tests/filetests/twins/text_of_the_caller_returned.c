//@ prints: axis 3
#include "KMotionDef.h"

char *Name(char *text, int axis)
{
    char *p = text;
    sprintf(p, "axis %d", axis);
    return p;
}

main()
{
    char text[16];
    printf("%s\n", Name(text, 3));
}
