// cc67: run --set persist.14=0 --set persist.15=0x405EC000
//
// doubles.c - doubles in pairs of persist elements.
//
//   cc67 run c-programs/persist/doubles.c --set persist.14=0 --set persist.15=0x405EC000
//
// A double takes two elements, the low word first, and begins at an even element:
// double number n is in the elements 2n and 2n+1. The PC's displays are passed
// in this way. The options above put 123.0 into double number 7.
//
// Expect 123 as input, 1122 as output, and 00000000 and 40918800 as its two words.

#include "KMotionDef.h"

#define IN  7               // double number, elements 14 and 15
#define OUT 8               // double number, elements 16 and 17

main()
{
    double *Value = (double *)persist.UserData;

    Value[OUT] = Value[IN] + 999.0;

    printf("in  %f\n", Value[IN]);
    printf("out %f\n", Value[OUT]);
    printf("out as words: low %08X, high %08X\n",
           persist.UserData[2 * OUT], persist.UserData[2 * OUT + 1]);
}
