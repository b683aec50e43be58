//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    char name[20];

    name = "spindle";
    printf("%s\n", name);
}
