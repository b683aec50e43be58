//@ args: check
//@ says: warning[text-overflow]: `fgets` may store 80 bytes in `line`, which has 20
//@ says: line_longer_than_its_array.c:10:5
#include "KMotionDef.h"

main()
{
    char line[20];
    FILE *f = fopen("data.txt", "rt");
    fgets(line, 80, f);
    fclose(f);
}
