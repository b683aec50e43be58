#include "KMotionDef.h"

main()
{
    Delay_sec(0.5);
    Jog(0, 0);
}
