//@ prints: 0
#include "KMotionDef.h"

main()
{
    int seconds = Time_sec();
    printf("%d\n", seconds);
}
