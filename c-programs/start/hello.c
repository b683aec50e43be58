// cc67: run
//
// hello.c - the smallest useful program: text on the console.
//
//   cc67 run c-programs/start/hello.c
//
// Expect two lines: the name of the board, and the thread the program runs in.

#include "KMotionDef.h"

main()
{
    printf("Hello from %s %s\n", BOARD, KMOTION_VER);
    printf("This is thread %d of %d\n", CurrentThread, N_USER_THREADS);
}
