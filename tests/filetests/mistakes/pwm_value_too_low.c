//@ says: thread 1 at pwm_value_too_low.c:6:5 in `main`: WritePWMR(1, -5000): values go from -400 to 400; it is limited to that
#include "KMotionDef.h"

main()
{
    WritePWMR(1, -5000);
}
