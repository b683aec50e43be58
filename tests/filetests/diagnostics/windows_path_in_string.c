//@ exit: 1
//@ snapshot
#include "KMotionDef.h"

main()
{
    FILE *f = fopen("C:\Program Files\data.txt", "wt");
}
