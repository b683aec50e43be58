// cc67: part of mailbox.c
//
// mailbox_receiver.c - prints and adds up the letters until the last one.

#include "KMotionDef.h"
#include "mailbox.h"

main()
{
    int Subject;
    float Value, Sum = 0.0f;

    do
    {
        while (!persist.UserData[BOX_FULL]) WaitNextTimeSlice();

        Subject = persist.UserData[BOX_SUBJECT];
        Value = *(float *)&persist.UserData[BOX_VALUE];
        if (Subject == SUBJECT_ADD)
        {
            Sum += Value;
            printf("received %.2f\n", Value);
        }
        *(float *)&persist.UserData[BOX_SUM] = Sum;
        persist.UserData[BOX_FULL] = FALSE;
    }
    while (Subject != SUBJECT_END);
}
