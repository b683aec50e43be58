// Overlap of unsigned ranges is found across the sign bit, an empty range as such.
//@ exit: 1
//@ says: `case 9223372036854775808` appears twice
//@ says: this range of cases is empty
#include "KMotionDef.h"

main()
{
    unsigned long long n = Time_sec();
    switch (n) {
    case 1 ... 0x8000000000000000ULL: break;
    case 0x8000000000000000ULL: break;
    case 0xffffffffffffffffULL ... 2: break;
    }
}
