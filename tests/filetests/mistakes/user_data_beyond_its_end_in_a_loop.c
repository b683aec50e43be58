//@ says: a value is stored in persist.UserData[200], but valid indices are 0 to 199: other data of the board are overwritten
#include "KMotionDef.h"

main()
{
    int i, base = persist.UserData[9] + 190;
    for (i = 0; i < 16; i++) persist.UserData[base + i] = i + 1;
}
