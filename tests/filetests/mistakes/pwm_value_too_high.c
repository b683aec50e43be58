//@ says: thread 1 at pwm_value_too_high.c:6:5 in `main`: WritePWM(0, 1000): values go from -230 to 230; it is limited to that
#include "KMotionDef.h"

main()
{
    WritePWM(0, 1000);
}
