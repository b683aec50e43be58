//@ args: --stim parts/modbus.stim
//@ prints: 01 03 02 00 2a 39 9b
#include "KMotionDef.h"

void Send(unsigned char *bytes, int count)
{
    int i;
    for (i = 0; i < count; i++)
    {
        while (FPGA(RS232_STATUS) & RS232_TRANSMIT_FULL) WaitNextTimeSlice();
        FPGA(RS232_DATA) = bytes[i];
    }
}

main()
{
    unsigned char request[8] = { 1, 3, 0, 0, 0, 1, 0x84, 0x0a };
    char line[40];
    int got = 0;
    double start;

    InitRS232(RS232_BAUD_115200);
    Send(request, 8);
    start = Time_sec();
    while (got < 7 && Time_sec() - start < 0.1)
    {
        if (FPGA(RS232_STATUS) & RS232_DATA_READY)
        {
            sprintf(line + 3 * got, "%02x ", FPGA(RS232_DATA) & 0xff);
            got++;
        }
    }
    line[3 * got - 1] = 0;
    printf("%s\n", line);
}
