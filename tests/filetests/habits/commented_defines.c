// Nearly every define carries a remark; one has a block comment, one a semicolon too many.
//@ prints: spindle 152 coolant 153 dwell 0.50 ramp 1.50
#include "KMotionDef.h"

#define SPINDLE_BIT 152     // relay 1, "forward"
#define COOLANT_BIT 153     /* relay 2 */
#define DWELL 0.5           // seconds; don't make it shorter
#define RAMP (DWELL * 3)    // scaled
#define DEBUG               // nothing behind it
#define STEPS 4;            // the semicolon goes along

main()
{
    int n = STEPS
#ifdef DEBUG
    printf("spindle %d coolant %d dwell %.2f ramp %.2f\n", SPINDLE_BIT, COOLANT_BIT, DWELL, RAMP);
#endif
    if (n != 4) printf("wrong\n");
}
//@ cycles: 17688
