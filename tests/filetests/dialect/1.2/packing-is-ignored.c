//@ prints: 8 16
#include "KMotionDef.h"

#pragma pack(1) //~ note: `#pragma pack(1)` is ignored
struct P { char c; int i; } __attribute__((packed));
struct Q { char c; double d; };
_Static_assert(sizeof(struct P) == 8 && sizeof(struct Q) == 16, "natural alignment");

main()
{
    printf("%d %d\n", sizeof(struct P), sizeof(struct Q));
}
//@ cycles: 4830
