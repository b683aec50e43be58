#include "KMotionDef.h"

main()
{
    int i;
    for (i = 108; i < 200; i++) persist.UserData[i] = 0;
}
