// cc67: run
//
// modbus.c - the speed of an inverter, written over the serial port with Modbus RTU.
//
//   cc67 run --stim c-programs/serial/modbus.stim c-programs/serial/modbus.c
//
// A frame is the address of the device, a function, a register, a value, and a check sum
// over all of it, low byte first. A device that has understood repeats the frame. No answer
// within a tenth of a second, or another one, is an error.
//
// The file beside this program is the inverter. Expect the eight bytes of each frame, and
// two answers.

#include "KMotionDef.h"

#define DEVICE   1
#define WRITE    6                  // one register
#define REG_RUN  0x2000
#define REG_HZ   0x2001             // hundredths of a hertz
#define LENGTH   8

// The check sum of Modbus: CRC-16 with the polynomial A001 hex.
int Crc(unsigned char *Data, int Count)
{
    int i, Sum = 0xffff;

    while (Count-- > 0)
    {
        Sum ^= *Data++;
        for (i = 0; i < 8; i++) Sum = Sum & 1 ? Sum >> 1 ^ 0xa001 : Sum >> 1;
    }
    return Sum;
}

// Reads a character. FALSE: none came in time.
int Receive(unsigned char *To, double Limit)
{
    while (pRS232RecIn == pRS232RecOut)
    {
        if (WaitNextTimeSlice() > Limit) return FALSE;
    }
    *To = RS232_GetChar();
    return TRUE;
}

int WriteRegister(int Register, int Value)
{
    unsigned char Frame[LENGTH], Answer;
    int i, Sum;

    Frame[0] = DEVICE;
    Frame[1] = WRITE;
    Frame[2] = Register >> 8;
    Frame[3] = Register;
    Frame[4] = Value >> 8;
    Frame[5] = Value;
    Sum = Crc(Frame, LENGTH - 2);
    Frame[6] = Sum;
    Frame[7] = Sum >> 8;

    for (i = 0; i < LENGTH; i++)
    {
        printf("%02X ", Frame[i]);
        RS232_PutChar(Frame[i]);
    }
    for (i = 0; i < LENGTH; i++)
    {
        if (!Receive(&Answer, Time_sec() + 0.1) || Answer != Frame[i])
        {
            printf("no answer\n");
            return FALSE;
        }
    }
    printf("understood\n");
    return TRUE;
}

main()
{
    EnableRS232Cmds(RS232_BAUD_19200);
    DoRS232Cmds = FALSE;                // the characters are for this program
    WriteRegister(REG_HZ, 3500);        // 35 Hz
    WriteRegister(REG_RUN, 1);
}
