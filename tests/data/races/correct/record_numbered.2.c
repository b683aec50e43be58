#include "KMotionDef.h"

main()
{
    int number, i, sum;

    for (;;)
    {
        do
        {
            number = persist.UserData[150];
            sum = 0;
            for (i = 0; i < 4; i++)
                sum += persist.UserData[151 + i];
        } while ((number & 1) || number != persist.UserData[150]);
        if (number < 0)
            break;
        persist.UserData[160] = sum;
    }
}
