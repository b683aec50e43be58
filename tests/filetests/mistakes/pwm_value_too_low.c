//@ says: thread 1 at pwm_value_too_low.c:6:5 in `main`: WritePWMR(1, -5000): the range is -400 to 400, and the value is limited to it
#include "KMotionDef.h"

main()
{
    WritePWMR(1, -5000);
}
