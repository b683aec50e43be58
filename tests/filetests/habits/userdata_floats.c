// Parameters of an M code: floats in the ints of persist.UserData, read through casts.
//@ args: run --set persist.10=f:12.5 --set persist.11=f:-3 --set persist.12=1
//@ prints: feed 12.50 depth -3.00 coolant 1
//@ prints: time 0.240 s
#include "KMotionDef.h"

#define FEED_VAR 10
#define DEPTH_VAR 11
#define COOLANT_VAR 12
#define RESULT_VAR 13

main()
{
    float feed = *(float *)&persist.UserData[FEED_VAR]; // in mm per second
    float depth = *(float *)&persist.UserData[DEPTH_VAR];
    int coolant = persist.UserData[COOLANT_VAR];

    printf("feed %.2f depth %.2f coolant %d\n", feed, depth, coolant);
    *(float *)&persist.UserData[RESULT_VAR] = -depth / feed;
    printf("time %.3f s\n", *(float *)&persist.UserData[RESULT_VAR]);
}
