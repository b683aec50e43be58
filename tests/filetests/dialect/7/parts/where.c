#include "KMotionDef.h"

main()
{
    Delay_sec(0.01);
    printf("thread %d at 0x%x\n", CurrentThread, (unsigned)main >> 16);
}
