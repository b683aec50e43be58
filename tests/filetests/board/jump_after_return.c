//@ exit: 3
//@ says: jump_after_return.c:15:9 in `main`: `longjmp` to the buffer at
//@ says: but the function that called `setjmp` there has returned
//@ prints: marked
#include <setjmp.h>
#include <stdio.h>

jmp_buf place;
int mark(void) { return setjmp(place); }

main()
{
    if (mark() == 0) {
        printf("marked\n");
        longjmp(place, 1);
    }
    printf("never\n");
}
//@ cycles: 1773
