//@ says: thread 1 at kstep_input_without_a_kstep.c:6:9 in `main`: ReadBit(168): inputs of a KStep read 0 until KStepPresent is set: write KStepPresent = TRUE first
#include "KMotionDef.h"

main()
{
    if (ReadBit(168)) printf("limit\n");
}
