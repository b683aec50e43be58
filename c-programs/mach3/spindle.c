// cc67: run --set persist.1=-1 --set persist.2=f:1500
//
// spindle.c - the spindle for Mach3: direction and speed as the plug-in stores them.
//
//   cc67 run c-programs/mach3/spindle.c --set persist.1=-1 --set persist.2=f:1500
//
// One element is the direction, 1, 0 or -1; the next the speed in turns per minute, as a
// float. The program switches the relays of an inverter and puts the speed on an analog
// output. A change of direction first takes the speed away and waits.
//
// Expect the relay for counterclockwise and half of the voltage of 3000 turns.

#include "KMotionDef.h"

#define DIRECTION 1                 // persist
#define SPEED     2                 // persist, a float
#define RELAY_CW  152
#define RELAY_CCW 153
#define CHANNEL   0                 // analog output; Kanalog's are inverted
#define MAX_RPM   3000.0f

void Output(float Rpm)
{
    DAC(CHANNEL, (int)(Rpm / MAX_RPM * -2047.0f));
}

main()
{
    int Direction = persist.UserData[DIRECTION];
    float Rpm = *(float *)&persist.UserData[SPEED];

    if (Rpm > MAX_RPM) Rpm = MAX_RPM;
    if (ReadBit(Direction > 0 ? RELAY_CCW : RELAY_CW))
    {
        Output(0.0f);
        Delay_sec(2.0);             // runs down
    }
    SetStateBit(RELAY_CW, Direction > 0);
    SetStateBit(RELAY_CCW, Direction < 0);
    Output(Direction ? Rpm : 0.0f);

    printf("cw %d ccw %d, %.1f V\n", ReadBit(RELAY_CW), ReadBit(RELAY_CCW),
           KANALOG_CONVERT_DAC_TO_VOLTS((DAC_Buffer[CHANNEL] & 0xfff) - 2048));
}
