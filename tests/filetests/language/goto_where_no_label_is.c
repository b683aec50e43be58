// `goto *` with anything but the address of a label of the function stops the thread.
//@ exit: 3
//@ says: goto_where_no_label_is.c:12
//@ says: `goto *` to something other than a label
#include "KMotionDef.h"

main()
{
    void *to = &&here;
    to = (char *)to + 77;
here:
    goto *to;
}
//@ cycles: 5
