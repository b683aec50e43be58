#include "KMotionDef.h"

main()
{
    printf("spindle on\n");
}
