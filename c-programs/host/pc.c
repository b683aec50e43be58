// pc.c - included by other programs: asking the PC application for something.
//
// A request is a number in one element of persist, its parameters follow it.
// The PC sees them with its next status poll, does what is asked, and replaces the
// number by 0, or by a negative number when it refused.

#ifndef PC_C
#define PC_C

#include "KMotionDef.h"

#define REQUEST   PC_COMM_PERSIST
#define PARAMETER (PC_COMM_PERSIST + 1)

#define TEXT_WORDS 250              // room for a text of 1000 characters
#define TEXT_AT    1000             // its place in the gather buffer, in words of 4 bytes

// Waits for the PC. 0: done; negative: refused.
int Ask(int Request)
{
    int Answer;

    persist.UserData[REQUEST] = Request;
    do
    {
        WaitNextTimeSlice();
        Answer = persist.UserData[REQUEST];
    }
    while (Answer > 0);
    return Answer;
}

int AskInt(int Request, int Value)
{
    persist.UserData[PARAMETER] = Value;
    return Ask(Request);
}

int AskFloat(int Request, float Value)
{
    *(float *)&persist.UserData[PARAMETER] = Value;
    return Ask(Request);
}

// Texts are too long for persist; they are in the gather buffer and the parameter
// says where.
int AskText(int Request, char *Text)
{
    char *To = (char *)gather_buffer + 4 * TEXT_AT;
    int Room = 4 * TEXT_WORDS - 1;

    while (*Text && Room-- > 0) *To++ = *Text++;
    *To = 0;
    return AskInt(Request, TEXT_AT);
}

// Returns the button the operator pressed: IDOK, IDYES, IDNO, ...
int MessageBox(char *Text, int Style)
{
    persist.UserData[PARAMETER + 1] = Style;
    persist.UserData[PARAMETER + 2] = 0;
    AskText(PC_COMM_MSG, Text);
    return persist.UserData[PARAMETER + 2];
}

#endif
