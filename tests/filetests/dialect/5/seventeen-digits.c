// The board's digits, as recorded; on a PC all but -600 and 0.1 print otherwise.
//@ prints: -600 0.1 -708517702.57329714
//@ prints: 871301296524189.59 -0.00037879999999999998 0.24476066810886126
#include "KMotionDef.h"

main()
{
    printf("%.17g %.17g %.17g\n", -600.0, 0.1, -708517702.5732971);
    printf("%.17g %.17g %.17g\n", 871301296524189.1, -0.0003788, 0.24476066810886124);
}
//@ cycles: 57070
