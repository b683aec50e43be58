//@ prints: 319600
//@ processor: its stack is 2032 bytes
//@ says: warning[stack-size]: `main` needs 3224 bytes of the board's stack, which has 2048
//@ says:    ┌─ big_array_on_the_stack.c:17:1
//@ says:    │
//@ says: 17 │ main()
//@ says:    │ ^^^^
//@ says: 18 │ {
//@ says: 19 │     int numbers[800];
//@ says:    │         ------- 3200 bytes
//@ says:    │
//@ says:    = nothing guards the end of the stack: an overflow overwrites the next thread's stack
//@ says:    = help: make large arrays `static`, or declare them outside the function
//@ says: thread 1 at big_array_on_the_stack.c:21:31 in `main`: 3224 bytes of stack used; the board has about 1900
#include "KMotionDef.h"

main()
{
    int numbers[800];
    int i, sum = 0;
    for (i = 0; i < 800; i++) numbers[i] = i;
    for (i = 0; i < 800; i++) sum += numbers[i];
    printf("%d\n", sum);
}
