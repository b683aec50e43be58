//@ prints: position 0.000000
#include "KMotionDef.h"

main()
{
    char text[40];
    sprintf(text, "position %f", ch0->Dest);
    printf("%s\n", text);
}
