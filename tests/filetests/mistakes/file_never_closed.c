//@ scratch
//@ says: log.txt is still open for writing: call fclose, else the PC keeps the file open
#include "KMotionDef.h"

main()
{
    FILE *f = fopen("log.txt", "wt");
    fprintf(f, "1\n");
}
