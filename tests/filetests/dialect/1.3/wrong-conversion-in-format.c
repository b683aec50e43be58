//@ prints: goes on
#include "KMotionDef.h"

main()
{
    char text[100];
    double d = 2.5;
    sprintf(text, "%d %d", d, 3); //~ format
    sprintf(text, "%f", 3); //~ format
    printf("goes on\n");
}
//@ cycles: 10288
