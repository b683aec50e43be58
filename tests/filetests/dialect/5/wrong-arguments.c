//@ prints: goes on
#include "KMotionDef.h"

int value;

main()
{
    char text[80];
    sprintf(text, "%d", 1.5); //~ format
    sprintf(text, "%d", &value); //~ format
    sprintf(text, "%X", text); //~ format
    sprintf(text, "%d", 1, 2); //~ format
    printf("goes on\n");
}
//@ cycles: 11379
