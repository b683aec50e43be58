//@ args: check
//@ says: warning[shadow]: this `touched` shadows the `touched` of the block around it
//@ says: local_that_hides_one_of_the_block_around_it.c:14:16
//@ says: this one keeps its first value
#include "KMotionDef.h"

main()
{
    int i;
    double sum = 0, touched = 0;

    for (i = 0; i < 3; i++)
    {
        double touched;
        Jog(2, -500);
        while (!ReadBit(139)) WaitNextTimeSlice();
        touched = ch2->Dest;
        Jog(2, 0);
        while (!CheckDone(2)) WaitNextTimeSlice();
        sum += touched;
    }
    printf("last %.1f mean %.1f\n", touched, sum / 3);
}
