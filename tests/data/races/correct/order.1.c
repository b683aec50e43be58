#include "KMotionDef.h"

#define ORDER persist.UserData[20]
#define X persist.UserData[21]
#define Y persist.UserData[22]

main()
{
    int i;

    for (i = 1; i <= 100; i++)
    {
        X = i;
        Y = -i;
        ORDER = 1;
        while (ORDER)
            ;
    }
    ORDER = -1;
}
