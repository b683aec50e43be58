//@ exit: 1
//@ args: -Werror=lax-text
//@ snapshot
#include "KMotionDef.h"

main()
{
    FILE *f = fopen("C:\Program Files\data.txt", "wt");
}
