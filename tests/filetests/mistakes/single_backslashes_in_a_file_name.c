//@ args: check
//@ says: warning[file-name]: `\t` in the name of a file
//@ says: single_backslashes_in_a_file_name.c:8:24
#include "KMotionDef.h"

main()
{
    FILE *file = fopen("c:\temp\new.txt", "wt");
    if (file)
        fclose(file);
}
