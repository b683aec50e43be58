// cc67: run --set persist.6=10101
//
// notify.c - a program that the PC starts with a message number.
//
//   cc67 run c-programs/host/notify.c --set persist.6=10101
//
// The screen of the PC application has buttons that send numbers. Here three of them
// take over the measured position of an axis as its commanded one, as is needed when
// an axis has been turned by hand. All others are reported.
//
// Expect message 10101 to set the Y axis to where its encoder says it is.

#include "KMotionDef.h"

#define MESSAGE    6            // persist: the number
#define TAKE_FIRST 10100        // 10100 X, 10101 Y, 10102 Z
#define AXES       3

void TakeMeasured(int Axis)
{
    DisableAxis(Axis);
    EnableAxisDest(Axis, chan[Axis].Position);
    printf("%c: dest %.0f, position %.0f\n", 'X' + Axis, chan[Axis].Dest, chan[Axis].Position);
}

main()
{
    int Message = persist.UserData[MESSAGE];
    int Axis = Message - TAKE_FIRST;

    // Somebody has turned the axis by hand: here the program itself plays that.
    chan[1].InputMode = USER_INPUT_MODE;
    chan[1].Position = 1234.0;

    printf("message %d\n", Message);
    if (Axis >= 0 && Axis < AXES) TakeMeasured(Axis);
    else printf("not known\n");
}
