//@ prints: moving
//@ says: Jog: axis 2 has no OutputMode, so its Dest changes but no motor moves
#include "KMotionDef.h"

main()
{
    double X0 = ch2->Dest;
    ch2->InputMode = NO_INPUT_MODE;
    ch2->OutputMode = NO_OUTPUT_MODE;
    EnableAxisDest(2, 0.0);
    X0 = ch2->Dest;
    Jog(2, 100);
    while (X0 == ch2->Dest) ;
    printf("moving\n");
    Jog(2, 0);
}
//@ cycles: 176420
