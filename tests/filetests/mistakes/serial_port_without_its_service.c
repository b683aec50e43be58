//@ says: thread 1 at serial_port_without_its_service.c:7:5 in `main`: RS232_PutChar: nothing moves characters between the serial port and its buffers yet: call EnableRS232Cmds first
#include "KMotionDef.h"

main()
{
    InitRS232(RS232_BAUD_9600);
    RS232_PutChar('A');
    Delay_sec(0.1);
}
