// cc67: run
//
// serial.c - a question and an answer on the serial port.
//
//   cc67 run c-programs/io/serial.c
//
// Characters are sent and received in the background through two buffers. The
// service would take what is received as commands for the board; a program that
// wants it for itself switches that off right after the start.
//
// Expect "no answer": nothing is connected. With a device, or with received bytes
// from a stimulus file, its line is printed instead.

#include "KMotionDef.h"

#define LINE     40
#define TIME_OUT 0.05       // seconds without a complete line

void SendText(char *s)
{
    while (*s) RS232_PutChar(*s++);
}

int Received(void)
{
    return pRS232RecIn != pRS232RecOut;
}

// Collects characters up to a carriage return. FALSE when the device is silent.
int ReadLine(char *Line)
{
    int n = 0;
    char c;
    double Limit = Time_sec() + TIME_OUT;

    for (;;)
    {
        while (!Received())
        {
            if (WaitNextTimeSlice() > Limit) return FALSE;
        }
        c = RS232_GetChar();
        if (c == '\r') break;
        if (n < LINE - 1) Line[n++] = c;
    }
    Line[n] = 0;
    return TRUE;
}

main()
{
    char Answer[LINE];

    EnableRS232Cmds(RS232_BAUD_38400);
    DoRS232Cmds = FALSE;

    SendText("POS?\r");
    while (pRS232TxOut != pRS232TxIn) WaitNextTimeSlice();
    printf("question sent\n");

    if (ReadLine(Answer)) printf("answer: %s\n", Answer);
    else printf("no answer\n");
}
