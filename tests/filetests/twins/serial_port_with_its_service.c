#include "KMotionDef.h"

main()
{
    EnableRS232Cmds(RS232_BAUD_9600);
    DoRS232Cmds = FALSE;
    RS232_PutChar('A');
    Delay_sec(0.1);
}
