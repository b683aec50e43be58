//@ says: thread 1 at pwm_value_too_high.c:6:5 in `main`: WritePWM(0, 1000): the range is -230 to 230, and the value is limited to it
#include "KMotionDef.h"

main()
{
    WritePWM(0, 1000);
}
