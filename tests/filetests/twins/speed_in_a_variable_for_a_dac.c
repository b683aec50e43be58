#include "KMotionDef.h"

main()
{
    int speed = 2000, other = 3000;
    DAC(2, speed);
    if (other > 2047) other = 2047;
    DAC(3, other);
}
