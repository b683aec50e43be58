// flash_bank.c - SetFlashBank refuses the boot sector, and says so unless that bank was the last one refused.

#include "KMotionDef.h"

int data[16];
unsigned at[] = {0x90100000, 0x90000000, 0x90000002, 0x90003FFE, 0x90004000, 0x90007000, 0x9000FFFE, 0x90010000, 0x90000000,
                 0x90020000, 0x9000AAAA, 0x90005554, 0xAAAA, 0x5554, 0x5555, 0xAAAA, 0xAAAC, 0x900FFFFE, 0x90200000, 0x90400000,
                 0x901F0000, 0x10000000, 0};

main()
{
    int i;
    SetFlashBank((unsigned short *)FLASH);
    for (i = 0; i < sizeof(at) / sizeof(at[0]); i++)
    {
        printf("%x\n", at[i]);
        Delay_sec(0.01);
        SetFlashBank((unsigned short *)at[i]);
    }
    SetFlashBank((unsigned short *)FLASH_USER);
    printf("%d\n", ProgramFlashNoMessages((volatile char *)data, 32, FLASH_USER));
    Delay_sec(0.01);
    SetFlashBank((unsigned short *)FLASH);
    printf("%d\n", ProgramFlashNoMessages((volatile char *)data, 32, FLASH_USER + 0x10000));
    Delay_sec(0.01);
    SetFlashBank((unsigned short *)FLASH);
}
