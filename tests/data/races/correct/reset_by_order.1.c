#include "KMotionDef.h"

#define COUNT persist.UserData[14]

main()
{
    int i;

    for (i = 0; i < 500; i++)
    {
        while (COUNT >= 5)
            ;
        COUNT++;
    }
}
