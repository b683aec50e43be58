// cc67: run also 2:mailbox_receiver.c
//
// mailbox.c - handing values from one thread to another through persist.
//
//   cc67 run 1:c-programs/persist/mailbox.c 2:c-programs/persist/mailbox_receiver.c
//
// One element says whether the box is full. The sender fills the box first and
// raises the flag last; the receiver empties the box first and lowers it last.
//
// Expect five letters in order, printed by thread 2, and the sum of them by thread 1.

#include "KMotionDef.h"
#include "mailbox.h"

void Send(int Subject, float Value)
{
    while (persist.UserData[BOX_FULL]) WaitNextTimeSlice();

    persist.UserData[BOX_SUBJECT] = Subject;
    *(float *)&persist.UserData[BOX_VALUE] = Value;
    persist.UserData[BOX_FULL] = TRUE;
}

main()
{
    int i;

    persist.UserData[BOX_FULL] = FALSE;
    StartThread(2);

    for (i = 1; i <= 5; i++) Send(SUBJECT_ADD, 1.5f * i);
    Send(SUBJECT_END, 0.0f);

    while (persist.UserData[BOX_FULL]) WaitNextTimeSlice();
    printf("sum %.2f\n", *(float *)&persist.UserData[BOX_SUM]);
}
