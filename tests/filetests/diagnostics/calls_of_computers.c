//@ exit: 1
//@ snapshot
#include "KMotionDef.h"
#include <stdio.h>

main()
{
    FILE *file = fopen("a.txt", "wt");
    int key = getchar();
    fputs("text", file);
    fwrite(&key, 4, 1, file);
    fprintf(stdout, "key %d\n", key);
}
