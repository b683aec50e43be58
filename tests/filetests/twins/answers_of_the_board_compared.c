//@ prints: disabled
//@ prints: off
#include "KMotionDef.h"

main()
{
    if (CheckDone(0) == -1) printf("disabled\n");
    if (ReadBit(1030) != 1) printf("off\n");
}
