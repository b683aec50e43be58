//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    int last = 0 pulses = 0;

    while (pulses < 10) {
        if (ReadBit(16) != last) {
            last = !last;
            pulses = pulses + 1;
        }
    }
}
