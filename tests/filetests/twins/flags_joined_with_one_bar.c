//@ prints: 52
#include "KMotionDef.h"

#define SHOW_BUTTONS 4
#define SHOW_SIGN 48

main()
{
    printf("%d\n", SHOW_BUTTONS | SHOW_SIGN);
}
