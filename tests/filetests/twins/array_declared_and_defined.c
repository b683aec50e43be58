//@ prints: axis 3
#include "KMotionDef.h"

extern char text[];
char text[80];

main()
{
    sprintf(text, "axis %d", 3);
    printf("%s\n", text);
}
