#include "KMotionDef.h"

main()
{
    int i, base = persist.UserData[9] + 184;
    for (i = 0; i < 16; i++) persist.UserData[base + i] = i + 1;
}
