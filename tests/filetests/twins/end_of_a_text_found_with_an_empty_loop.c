//@ prints: X10!
#include "KMotionDef.h"

char text[20] = "X10";

main()
{
    int i;
    for (i = 0; text[i]; i++) ;
    text[i] = '!';
    printf("%s\n", text);
}
