//@ args: check
//@ says: warning[implicit-declaration]: `abs` is not declared
//@ says: abs_of_a_double.c:11:9
//@ says: warning[lost-fraction]: `abs` takes an `int`: the fraction is lost
//@ says: abs_of_a_double.c:11:13
#include "KMotionDef.h"

main()
{
    double error = ch0->Dest - ch0->Position;
    if (abs(error) < 1) printf("close\n");
}
