//@ args: check
//@ says: warning[int-pointer]: argument 1 of `printf` makes a pointer from an integer without a cast
//@ says: single_quotes_around_a_text.c:8:12
//@ says: text has double quotes: `"x"`
#include "KMotionDef.h"
main()
{
    printf('x');
}
