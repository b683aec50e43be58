/* Works through the gather buffer, which no other thread uses. */
#include "KMotionDef.h"

main()
{
    int i;

    for (;;)
        for (i = 0; i < 10000; i++)
            gather_buffer[i] = gather_buffer[i] * 0.5 + i;
}
