//@ scratch
#include "KMotionDef.h"

main()
{
    FILE *f = fopen("log.txt", "wt");
    fprintf(f, "1\n");
    fclose(f);
}
