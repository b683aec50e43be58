// cc67: run
//
// receive.c - lines received through the registers of the serial port, without its buffers.
//
//   cc67 run --stim c-programs/serial/receive.stim c-programs/serial/receive.c
//
// The port holds two characters that nobody has read yet; a third one overwrites the
// second. At 38400 baud a character comes every 0.26 ms: a single program that looks in
// each of its slices, every 0.18 ms, loses none. One that sleeps for a while does.
//
// The file beside this program plays the other end of the line: it sends the same text
// twice. Expect the first one complete; of the second, the first character and the last.

#include "KMotionDef.h"

#define NONE (-1)

int Ready(void)
{
    return FPGA(RS232_STATUS) & RS232_DATA_READY;
}

// Reads to the end of a line, or until nothing has come for 10 ms.
int ReadLine(char *Line, int Size)
{
    int n = 0;
    char c;
    double Last = Time_sec();

    for (;;)
    {
        WaitNextTimeSlice();
        if (!Ready())
        {
            if (Time_sec() - Last > 0.01) break;
            continue;
        }
        c = FPGA(RS232_DATA);
        Last = Time_sec();
        if (c == '\r') break;
        if (n < Size - 1) Line[n++] = c;
    }
    Line[n] = 0;
    return n;
}

main()
{
    char Line[40];

    SetBitDirection(45, 1);
    FPGA(KAN_TRIG_REG) = 2;
    FPGA(RS232_BAUD_REG) = RS232_BAUD_38400;

    while (!Ready()) ;
    ReadLine(Line, sizeof(Line));
    printf("read in time: \"%s\"\n", Line);

    Delay_sec(0.3);                             // busy with something else
    ReadLine(Line, sizeof(Line));
    printf("read too late: \"%s\"\n", Line);
}
