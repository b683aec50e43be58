#include "KMotionDef.h"

#define SETTLE_MS 250

main()
{
    int ms = SETTLE_MS;
    Delay_sec(0.001 * ms);
}
