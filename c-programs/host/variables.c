// cc67: run
//
// variables.c - exchanging numbers with the G code program on the PC.
//
//   cc67 run c-programs/host/variables.c
//
// G code variables (#100, #101, ...) are copied from and to doubles in persist. Other
// requests set displays and overrides, or refuse what makes no sense.
//
// Expect the three values back as they were sent, and a negative answer to an
// override out of range.

#include "KMotionDef.h"
#include "pc.c"

#define SENT     10             // double numbers in persist: elements 20 to 25
#define RECEIVED 13             // and 26 to 31
#define FIRST    100            // #100 to #102
#define COUNT    3

int CopyVariables(int Request, int First, int Count, int Double)
{
    persist.UserData[PARAMETER + 1] = Count;
    persist.UserData[PARAMETER + 2] = Double;
    return AskInt(Request, First);
}

main()
{
    int i, Answer;
    double *Value = (double *)persist.UserData;

    for (i = 0; i < COUNT; i++) Value[SENT + i] = 123.456 * (i + 1);

    Answer = CopyVariables(PC_COMM_SET_VARS, FIRST, COUNT, SENT);
    printf("sent: %d\n", Answer);
    Answer = CopyVariables(PC_COMM_GET_VARS, FIRST, COUNT, RECEIVED);
    printf("received: %d\n", Answer);
    for (i = 0; i < COUNT; i++) printf("#%d = %.3f\n", FIRST + i, Value[RECEIVED + i]);

    printf("X display: %d\n", AskFloat(PC_COMM_SET_X, 1.25f));
    printf("feed 80 %%: %d\n", AskFloat(PC_COMM_SET_FRO, 0.8f));
    printf("feed -50 %%: %s\n", AskFloat(PC_COMM_SET_FRO, -0.5f) < 0 ? "refused" : "accepted");

    SetFRO(1.0f);
}
