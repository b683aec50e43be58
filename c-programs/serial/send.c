// cc67: run
//
// send.c - characters sent through the registers of the serial port, without its buffers.
//
//   cc67 run c-programs/serial/send.c
//
// The port holds one character while another one is on the line. While both places are
// taken, the status says that it is full; a character written then would be lost.
//
// A character has 10 bits, so 100 of them take 1000 / 38400 s = 26.0 ms. The divisor
// is a whole number, the real rate a little higher.
//
// Expect that time, and a first character that did not have to wait.

#include "KMotionDef.h"

#define COUNT 100

// Sends a character; returns whether it had to wait for the one before.
int SendChar(char c)
{
    int Waited = FALSE;

    while (FPGA(RS232_STATUS) & RS232_TRANSMIT_FULL) Waited = TRUE;
    FPGA(RS232_DATA) = c;
    return Waited;
}

main()
{
    int i, Waits = 0;
    double Start;

    SetBitDirection(45, 1);                     // the transmitter's pin
    FPGA(KAN_TRIG_REG) = 2;                     // connects the port to its pins
    FPGA(RS232_BAUD_REG) = RS232_BAUD_38400;

    WaitNextTimeSlice();
    Start = Time_sec();
    for (i = 0; i < COUNT; i++) Waits += SendChar('A');
    while (FPGA(RS232_STATUS) & RS232_TRANSMIT_FULL) ;
    Delay_sec(10 / 38400.0);                    // the last one is on the line

    printf("%d characters, %d of them waited, %.1f ms\n", COUNT, Waits, (Time_sec() - Start) * 1e3);
}
