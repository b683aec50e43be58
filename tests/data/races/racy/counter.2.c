#include "KMotionDef.h"

#define DONE persist.UserData[5]

void count(void)
{
    DONE += 2;  // <-
}

main()
{
    int i;

    for (i = 0; i < 3000; i++)
        count();
}
