#include "KMotionDef.h"

main()
{
    PauseThread(1);
    Delay_sec(0.2);
    ResumeThread(1);
}
