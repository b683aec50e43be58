//@ scratch
//@ says: second.txt is opened while first.txt is open: the PC writes one file at a time, so all further lines go to second.txt
#include "KMotionDef.h"

main()
{
    FILE *first = fopen("first.txt", "wt");
    FILE *second = fopen("second.txt", "wt");
    fprintf(first, "1\n");
    fprintf(second, "2\n");
    fclose(first);
    fclose(second);
}
