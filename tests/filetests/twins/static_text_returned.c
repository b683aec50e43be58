//@ prints: axis 3
#include "KMotionDef.h"

char *Name(int axis)
{
    static char text[16];
    sprintf(text, "axis %d", axis);
    return text;
}

main()
{
    printf("%s\n", Name(3));
}
