// A line was added below an if without braces.
//@ prints: coolant off
//@ prints: spindle off
#include "KMotionDef.h"

main()
{
    int running = 1;
    if (running)
        printf("coolant off\n");
        printf("spindle off\n"); //~ misleading-indentation
    while (running) running--;
}
//@ cycles: 5308
