//@ prints: 5
#include "KMotionDef.h"
#pragma TI_COMPILER
#pragma once_upon_a_time
//~^ note: once_upon_a_time

main() { printf("5\n"); }
//@ cycles: 783
