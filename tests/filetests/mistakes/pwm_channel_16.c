//@ says: thread 1 at pwm_channel_16.c:6:5 in `main`: WritePWMC(16, …): no such channel (0-15)
#include "KMotionDef.h"

main()
{
    WritePWMC(16, 10);
}
