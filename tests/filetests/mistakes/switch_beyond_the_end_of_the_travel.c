//@ args: --machine parts/switch_beyond.toml --for 0.1
//@ prints: 0
//@ says: the switch or probe on bit 136 (switch_beyond.toml:4) is active at ≤ -1000, but the travel of axis 0 ends at -900 (axis.0.min, switch_beyond.toml:2): it is never reached
#include "KMotionDef.h"

main()
{
    printf("%d\n", ReadBit(136));
}
