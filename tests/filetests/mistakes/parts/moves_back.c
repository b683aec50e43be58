#include "KMotionDef.h"

main()
{
    Delay_sec(0.5);
    Move(0, -5000);
}
