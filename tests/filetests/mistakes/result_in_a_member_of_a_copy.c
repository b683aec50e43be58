//@ args: check
//@ says: warning[parameter-copy]: `h` is a copy of the caller's value: what is stored in it stays in `Home`
//@ says: take the address, `HOME *h`, write `h->`, and call with `&` before the variable
//@ says: result_in_a_member_of_a_copy.c:14:5
#include "KMotionDef.h"

typedef struct { int axis; int homed; } HOME;
HOME X = { 0, 0 };

void Home(HOME h)
{
    Jog(h.axis, 0);
    Zero(h.axis);
    h.homed = 1;
}

main()
{
    Home(X);
    if (X.homed) printf("ready\n");
}
