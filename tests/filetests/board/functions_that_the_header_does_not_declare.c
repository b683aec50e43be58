//@ prints: 3 -2
//@ prints: -1
#include "KMotionDef.h"

double CubeRoot(double v);
void iOpenBuf(void);
void iExecBuf(void);

main()
{
    printf("%g %g\n", CubeRoot(27.0), CubeRoot(-8.0));
    iOpenBuf();
    iExecBuf();
    printf("%d\n", CheckDoneBuf());
}
