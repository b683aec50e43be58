// cc67: run
//
// message.c - a message box on the PC, and the operator's answer.
//
//   cc67 run c-programs/host/message.c
//
// Expect the texts of two boxes, and the answers of the simulated operator: yes to
// the question, OK to the note. The element of the request is 0 in the end.

#include "KMotionDef.h"
#include "pc.c"

main()
{
    int Answer = MessageBox("Is the tool length sensor in place?", MB_YESNO | MB_ICONEXCLAMATION);

    if (Answer == IDYES) printf("the sensor is in place\n");
    else if (Answer == IDNO) printf("measuring is skipped\n");
    else printf("unexpected answer %d\n", Answer);

    Answer = MessageBox("Measuring begins.", MB_OK);
    printf("answer %d, request %d\n", Answer, persist.UserData[PC_COMM_PERSIST]);
}
