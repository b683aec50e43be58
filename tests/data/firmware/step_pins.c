// step_pins.c - enabling an axis in a step mode makes the pins of its generator outputs, and they stay so.

#include "KMotionDef.h"

int at[6] = {8, 9, 22, 23, 36, 43};

Show(char *when)
{
    int i;
    printf("%s: %x %x,", when, BitDirShadow[0], BitDirShadow[1]);
    for (i = 0; i < 6; i++)
        printf(" %d", GetBitDirection(at[i]));
    printf(" %x %x %x\n", FPGA(BIT_DIR + 1), FPGA(BIT_DIR + 2), FPGA(BIT_DIR + 4));
}

Clear()
{
    int i;
    for (i = 0; i < 8; i++)
    {
        DisableAxis(i);
        chan[i].OutputMode = NO_OUTPUT_MODE;
    }
    for (i = 0; i < 46; i++)
        SetBitDirection(i, 0);
}

main()
{
    int i, mode;
    Show("start");
    for (mode = NO_OUTPUT_MODE; mode <= CL_MICROSTEP_MODE; mode++)
    {
        Clear();
        ch0->OutputMode = mode;
        ch0->OutputChan0 = 0;
        printf("mode %d ", mode);
        EnableAxis(0);
        Show("enabled");
        DisableAxis(0);
        Delay_sec(0.001);
        Show("disabled");
    }
    for (i = -2; i < 18; i++)
    {
        Clear();
        ch2->OutputMode = STEP_DIR_MODE;
        ch2->OutputChan0 = i;
        EnableAxisDest(2, 0.0);
        Delay_sec(0.001);
        DisableAxis(2);
        Delay_sec(0.001);
        printf("channel %d ", i);
        Show("was enabled");
    }
    Clear();
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 0;
    EnableAxis(0);
    ch0->OutputChan0 = 2;
    Delay_sec(0.001);
    printf("a channel of an enabled axis: %x %x\n", BitDirShadow[0], BitDirShadow[1]);
    EnableAxis(0);
    printf("enabled again: %x %x\n", BitDirShadow[0], BitDirShadow[1]);
    ch3->OutputChan0 = 5;
    ch3->OutputMode = STEP_DIR_MODE;
    ch3->Enable = TRUE;
    Delay_sec(0.001);
    printf("by the field: %x %x\n", BitDirShadow[0], BitDirShadow[1]);
    Clear();
    FPGA(STEP_PULSE_LENGTH_ADD) = 32 + 0x40;
    for (i = 0; i < 8; i++)
    {
        chan[i].OutputChan0 = i;
        chan[i].OutputMode = CL_STEP_DIR_MODE;
        EnableAxis(i);
        printf("moved pins %d: %x %x\n", i, BitDirShadow[0], BitDirShadow[1]);
    }
}
