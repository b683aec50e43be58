//@ args: check
//@ says: warning[redeclared]: `text` is declared with two different sizes
//@ says: array_with_two_sizes.c:7:6
#include "KMotionDef.h"

char text[80];
char text[1000];

main()
{
    sprintf(text, "axis %d", 3);
    printf("%s\n", text);
}
