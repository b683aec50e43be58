//@ args: --stim parts/slave.stim
//@ prints: register 42
//@ prints: OK
#include "KMotionDef.h"

char request[] = { 1, 3, 0, 0, 0, 1, 0x84, 0x0a };

void Put(char c)
{
    RS232_PutChar(c);
}

int Get(void)
{
    return RS232_GetChar() & 0xff;
}

main()
{
    int i, answer[7];
    char text[4];
    EnableRS232Cmds(RS232_BAUD_9600);
    DoRS232Cmds = FALSE;
    for (i = 0; i < 8; i++) Put(request[i]);
    for (i = 0; i < 7; i++) answer[i] = Get();
    printf("register %d\n", answer[3] * 256 + answer[4]);
    Put('A');
    Put('T');
    Put('\r');
    for (i = 0; i < 3; i++) text[i] = Get();
    text[2] = 0;
    printf("%s\n", text);
}
