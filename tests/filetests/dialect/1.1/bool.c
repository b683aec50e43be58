//@ prints: 1 5 1 0 6
#include "KMotionDef.h"

struct { char before; _Bool yes, no; char after; } s = { 5, 0, 1, 6 }; //~ redeclared

main()
{
    s.yes = 0.5;
    s.no = 0;
    printf("%d %d %d %d %d\n", sizeof(_Bool), s.before, s.yes, s.no, s.after);
}
//@ cycles: 10763
