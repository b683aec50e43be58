/* Both threads change one element by a load and a store. */
#include "KMotionDef.h"

main()
{
    for (;;)
        persist.UserData[40]++;
}
