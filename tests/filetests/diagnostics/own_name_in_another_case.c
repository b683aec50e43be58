//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

int pos;

main()
{
    pos = 5;
    printf("%d\n", Pos);
}
