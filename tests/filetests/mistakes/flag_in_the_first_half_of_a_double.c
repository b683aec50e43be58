//@ args: check
//@ says: warning[user-data-type]: `persist.UserData[140]` is the first half of a `double`
//@ says: flag_in_the_first_half_of_a_double.c:14:5
//@ says: a `double` takes two elements: index N of the doubles is elements 2 N and 2 N + 1
#include "KMotionDef.h"

#define OFFSET 70

main()
{
    double *d = (double *)persist.UserData;
    while (!persist.UserData[140]) WaitNextTimeSlice();
    printf("%.3f %.3f\n", d[OFFSET], d[OFFSET + 1]);
    persist.UserData[140] = 0;
}
