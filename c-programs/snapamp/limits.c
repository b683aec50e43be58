// cc67: run
//
// limits.c - current limits and the supply clamp of a SnapAmp, and a motor that is too strong.
//
//   cc67 run --stim c-programs/snapamp/limits.stim c-programs/snapamp/limits.c
//
// Until a program sets its current limits, a SnapAmp reports a fault and keeps all its
// bridges off. A fault is held for a quarter of a second, so a program waits for half a
// second after setting them before it moves anything.
//
// The clamp burns what a braking motor returns into the supply, from a voltage a little
// above that of the supply on.
//
// The file beside this program is the motor: at 0.8 s it takes more current than the
// limit of side A allows, for 10 ms. Expect the fault, and its end 0.25 s later.

#include "KMotionDef.h"

#define LEVEL  9                // 2 A
#define CLAMP  90.0

#define FAULT  0x01
#define OVER_A 0x02

int Status(void)
{
    return ReadSnapAmp(SNAP0 + SNAP_STATUS);
}

void SetLimits(int Base)
{
    WriteSnapAmp(Base + SNAP_PEAK_CUR_LIMIT0, LEVEL);
    WriteSnapAmp(Base + SNAP_PEAK_CUR_LIMIT1, LEVEL);
    WriteSnapAmp(Base + SNAP_SUPPLY_CLAMP0, SNAP_CONVERT_VOLTS_TO_ADC(CLAMP));
    WriteSnapAmp(Base + SNAP_SUPPLY_CLAMP1, SNAP_CONVERT_VOLTS_TO_ADC(CLAMP));
    WriteSnapAmp(Base + SNAP_SUPPLY_CLAMP_ENA0, 1);
    WriteSnapAmp(Base + SNAP_SUPPLY_CLAMP_ENA1, 1);
}

// Waits until the fault comes or goes and tells when.
void ShowChange(int Fault)
{
    while ((Status() & FAULT) != Fault) WaitNextTimeSlice();
    printf("%.2f s: status %02X%s\n", Time_sec(), Status(), Status() & OVER_A ? ", over-current on side A" : "");
}

main()
{
    printf("before the limits are set: status %02X\n", Status());
    SetLimits(SNAP0);
    Delay_sec(0.5);
    printf("%.2f s: status %02X\n", Time_sec(), Status());

    WritePWM(8, 100);
    ShowChange(FAULT);
    ShowChange(0);
    WritePWM(8, 0);

    printf("supply %.1f V\n", SNAP_CONVERT_ADC_TO_VOLTS(ReadSnapAmp(SNAP0 + SNAP_SUPPLY_VOLT0)));
    printf("side A %.0f F\n", ReadSnapAmp(SNAP0 + SNAP_TEMP0) / 8.0);
}
