#include "KMotionDef.h"

main()
{
    Delay_sec(1);
}
