//@ args: --machine parts/switch_beyond.toml --for 0.1
//@ prints: 0
//@ says: the machine file has a switch or probe on bit 136 that is active at ≤ -1000, but the travel of axis 0 ends at min = -900: it is never reached
#include "KMotionDef.h"

main()
{
    printf("%d\n", ReadBit(136));
}
