//@ says: a line is written, but no file is open for writing on the PC
#include "KMotionDef.h"

main()
{
    FILE *f = 0;
    fprintf(f, "line\n");
}
