//@ says: warning[implicit-declaration]: `free` is not declared
//@ says:    ┌─ block_freed_that_was_not_allocated.c:15:5
//@ says:    │
//@ says: 15 │     free(numbers);
//@ says:    │     ^^^^ the firmware's `void free(void *)` is used
//@ says:    │
//@ says:    = help: `KMotionDef.h` lacks it; declare it: `void free(void *);`
//@ says: thread 1 at block_freed_that_was_not_allocated.c:15:5 in `main`: free(0x80050080): no block of the heap starts there
#include "KMotionDef.h"

int numbers[4];

main()
{
    free(numbers);
}
