//@ prints: 0 7 0
#include "KMotionDef.h"

main()
{
    printf("%d %d %c\n", 0, 07, '\060');
}
