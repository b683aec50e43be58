//@ prints: Y20
#include "KMotionDef.h"

char text[20] = "X10 Y20";

main()
{
    char *p = text;
    while (p != text + 4 && p < text + 20) p++;
    printf("%s\n", p);
}
