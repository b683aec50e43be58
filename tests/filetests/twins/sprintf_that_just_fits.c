//@ prints: axis 3 7
#include "KMotionDef.h"

main()
{
    char text[9];
    sprintf(text, "axis %d %d", 3, 7);
    printf("%s\n", text);
}
