// exit calls what atexit registered, the last first; nothing behind exit runs.
//@ prints: main second first
#include "KMotionDef.h"

int atexit(void (*function)(void));
void exit(int status);
void first(void) { printf("first\n"); }
void second(void) { printf("second "); }

main()
{
    atexit(first);
    atexit(second);
    printf("main ");
    exit(0);
    printf("never\n");
}
//@ cycles: 4876
