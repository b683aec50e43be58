// cc67: run --set persist.10=f:1.23 --set persist.11=f:4.56 --set persist.12=f:-1
//
// mcode.c - the parameters P, Q and R of an M code.
//
//   cc67 run c-programs/persist/mcode.c --set persist.10=f:1.23 --set persist.11=f:4.56 --set persist.12=f:-1
//
// For a G code line such as M110 P1.23 Q4.56 R-1 the PC stores the values as
// floats in three elements in a row, the first of which is chosen in its set-up,
// and then starts the program. An element is an int: the bits of the float are
// looked at through a pointer, a plain conversion would give another number.
//
// Expect: P = 1.230000 Q = 4.560000 R = -1.000000

#include "KMotionDef.h"

#define FIRST 10            // persist: as entered in the PC's M code set-up

float *Parameter = (float *)&persist.UserData[FIRST];

main()
{
    printf("P = %f Q = %f R = %f\n", Parameter[0], Parameter[1], Parameter[2]);
}
