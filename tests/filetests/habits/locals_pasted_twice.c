// A block was pasted into a function that had its variables already.
//@ prints: first 1.50 second 2.50
#include "KMotionDef.h"

main()
{
    double Start = 1.5;
    printf("first %.2f ", Start);

    double Start = 2.5; //~ redeclared: Start
    printf("second %.2f\n", Start);
}
//@ cycles: 10374
