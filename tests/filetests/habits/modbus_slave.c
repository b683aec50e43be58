// A slave that answers a read request; its helpers are called first and defined below, without prototypes.
//@ prints: crc a84
//@ prints: answer 01 03 04 00 07 01 2c, 9 bytes
#include "KMotionDef.h"

unsigned char Request[8] = { 0x01, 0x03, 0x00, 0x00, 0x00, 0x01 };
unsigned char Answer[64];
unsigned short Registers[4] = { 7, 300, 0, 65535 };
int AnswerSize;

main()
{
    int i;
    int crc = CalcCrc(Request, 6);
    printf("crc %x\n", crc);
    BuildAnswer(0, 2);
    printf("answer");
    for (i = 0; i < 7; i++) printf(" %02x", Answer[i]);
    printf(", %d bytes\n", AnswerSize);
}

BuildAnswer(int first, int count)
{
    unsigned char *p = Answer;
    unsigned short r;
    int i;

    *p++ = Request[0];
    *p++ = 3;
    *p++ = count * 2;
    for (i = 0; i < count; i++)
    {
        r = ReadRegister(first + i);
        *p++ = r >> 8;
        *p++ = r & 0xff;
    }
    r = CalcCrc(Answer, p - Answer);
    *p++ = r & 0xff;
    *p++ = r >> 8;
    AnswerSize = p - Answer;
}

unsigned short ReadRegister(int n)
{
    return Registers[n & 3];
}

unsigned short CalcCrc(unsigned char *buffer, int n)
{
    unsigned short crc = 0xffff;
    int i;

    while (n--)
    {
        crc ^= *buffer++;
        for (i = 0; i < 8; i++)
        {
            if (crc & 1) crc = (crc >> 1) ^ 0xa001;
            else crc >>= 1;
        }
    }
    return crc;
}
//@ cycles: 29803
