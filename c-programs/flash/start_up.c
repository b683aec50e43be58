// cc67: run --for 4
//
// start_up.c - a program that the board starts by itself when the power comes on.
//
//   cc67 run --for 4 --stim c-programs/flash/start_up.stim c-programs/flash/start_up.c
//
// The threads to start are bits of persist.RunOnStartUp. With the next "Flash" of the PC
// they are kept together with the programs and all of persist. So a program can count the
// starts, and know whether it has set the machine up already.
//
// The file beside this program is the PC. Expect the first start, and the same program
// again after the reboot with what it had kept.

#include "KMotionDef.h"

#define MAGIC       123456          // says that the settings below are there
#define MAGIC_VAR   190             // persist
#define STARTS_VAR  191
#define THREAD      1

main()
{
    if (persist.UserData[MAGIC_VAR] != MAGIC)
    {
        persist.UserData[MAGIC_VAR] = MAGIC;
        persist.UserData[STARTS_VAR] = 0;
        persist.RunOnStartUp |= 1 << THREAD;
        printf("first start: the board will start this program by itself, once it is in flash\n");
    }
    persist.UserData[STARTS_VAR]++;
    printf("start number %d\n", persist.UserData[STARTS_VAR]);
}
