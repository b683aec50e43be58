//@ scratch
#include "KMotionDef.h"

main()
{
    FILE *f = fopen("first.txt", "wt");
    fprintf(f, "1\n");
    fclose(f);
    f = fopen("second.txt", "wt");
    fprintf(f, "2\n");
    fclose(f);
}
