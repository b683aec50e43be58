//@ exit: 3
//@ says: which no `setjmp` has set
#include <setjmp.h>

jmp_buf place;

main()
{
    longjmp(place, 1);
}
//@ cycles: 26
