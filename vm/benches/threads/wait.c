// A service loop: looks at an input once a time slice.

#include "KMotionDef.h"

int main(void)
{
    int count = 0;

    for (;;) {
        WaitNextTimeSlice();
        if (ReadBit(46))
            count++;
    }
}
