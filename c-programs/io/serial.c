// cc67: run
//
// serial.c - the serial port: how long sending takes, a question and its answer.
//
//   cc67 run c-programs/io/serial.c
//
// Characters are sent and received in the background through two buffers. The
// service would take what is received as commands for the board; a program that
// wants it for itself switches that off right after the start.
//
// A character has 10 bits with its start and stop bit, so 100 of them take
// 1000 / 38400 s = 26 ms.
//
// Expect that time, and "no answer": nothing is connected. With a device, its line
// is printed instead.

#include "KMotionDef.h"

#define LINE     40
#define SAMPLE   100        // characters whose sending is timed
#define TIME_OUT 0.05       // seconds without a complete line

void SendText(char *s)
{
    while (*s) RS232_PutChar(*s++);
}

// All characters are sent but the one on the line.
void WaitUntilSent(void)
{
    while (pRS232TxOut != pRS232TxIn) WaitNextTimeSlice();
    while (FPGA(RS232_STATUS) & RS232_TRANSMIT_FULL) ;
}

void ShowSpeed(void)
{
    int i;
    double T0 = Time_sec();

    for (i = 0; i < SAMPLE; i++) RS232_PutChar('U');
    WaitUntilSent();
    printf("%d characters in %.0f ms\n", SAMPLE, (Time_sec() - T0) * 1000.0);
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

    ShowSpeed();

    SendText("POS?\r");
    WaitUntilSent();
    printf("question sent\n");

    if (ReadLine(Answer)) printf("answer: %s\n", Answer);
    else printf("no answer\n");
}
