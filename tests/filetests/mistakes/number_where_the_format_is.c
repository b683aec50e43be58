//@ args: check
//@ says: error: argument 1 of `printf`: cannot convert `float` to `const char *`
//@ says: number_where_the_format_is.c:10:12
//@ says: text in double quotes is needed here, such as `"%g\n"` for `printf`
//@ exit: 1
#include "KMotionDef.h"
main()
{
    float x = 1.5;
    printf(x);
}
