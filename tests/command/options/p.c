// cc67: run --set persist.9=3
#include "KMotionDef.h"
#ifdef V
#include "v.h"
#endif
#ifdef W
int fraction = 0.5;
#endif
#ifdef __STDC_VERSION__
int standard = 0.5;
#endif
#ifndef __TINYC__
int undefined = 0.5;
#endif
#ifndef N
#define N 3
#endif

int missing(void);
int unused(void) { return missing(); }

int counted(int n)
{
    int i, sum = 0;
    for (i = 0; i < n; i++) sum += i;
    return sum;
}

main()
{
    char text[100];
    double start = Time_sec();
    int *odd = (int *)((char *)persist.UserData + 2);
    FILE *f;
    persist.UserData[7]++;
    counted(100);
    FPGA(200) = 1;
    SetBit(1);
    StartThread(3);
    start = Time_sec() - start;
    SetBitDirection(45, 1);
    FPGA(KAN_TRIG_REG) = 2;
    FPGA(RS232_BAUD_REG) = RS232_BAUD_38400;
    FPGA(RS232_DATA) = 'x';
    EnableAxis(0);
    Move(0, 100);
    while (!(FPGA(RS232_STATUS) & RS232_DATA_READY) && Time_sec() < 0.03) WaitNextTimeSlice();
    persist.UserData[PC_COMM_PERSIST] = PC_COMM_HALT;
    while (persist.UserData[PC_COMM_PERSIST] > 0) WaitNextTimeSlice();
    sprintf(text, "N %d, persist %d %d, bit %d, serial port %d, PC %d, %.7f s\n", N, persist.UserData[5],
            persist.UserData[9], ReadBit(48), FPGA(RS232_STATUS), persist.UserData[PC_COMM_PERSIST], start);
    printf("%s", text);
    f = fopen("a.txt", "wt");
    if (f)
    {
        fprintf(f, "%s", text);
        fclose(f);
    }
    while (!ReadBit(136)) WaitNextTimeSlice();
    *odd = 1;
    printf("end\n");
}
