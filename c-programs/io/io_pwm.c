// cc67: run
//
// io_pwm.c - a pulse width output as a speed signal for a spindle inverter.
//
//   cc67 run c-programs/io/io_pwm.c
//
// All eight PWM outputs share one divider of the 16.67 MHz clock; a period has 256
// counts. Each output has a value register and, next to it, an enable register.
//
// Expect a frequency of about 1 kHz and the register value of each speed.

#include "KMotionDef.h"

#define PWM       0                 // output 0, on bit 26
#define PWM_BIT   26
#define PRESCALE  65
#define MAX_RPM   6000.0f

int ValueFromRpm(float Rpm)
{
    if (Rpm <= 0.0f) return 0;
    if (Rpm >= MAX_RPM) return IO_PWM_MAX_VALUE;
    return (int)(Rpm / MAX_RPM * IO_PWM_MAX_VALUE + 0.5f);
}

void SpindleSpeed(float Rpm)
{
    int Value = ValueFromRpm(Rpm);

    FPGA(IO_PWMS + 2 * PWM) = Value;
    printf("%6.0f rpm: value %3d, %5.1f %%\n", Rpm, Value, 100.0f * Value / IO_PWM_MAX_VALUE);
}

main()
{
    float Rpm;

    SetBitDirection(PWM_BIT, 1);
    FPGA(IO_PWMS_PRESCALE) = PRESCALE;
    FPGA(IO_PWMS + 2 * PWM + 1) = 1;            // enable
    printf("%.0f Hz\n", 16666666.0 / (PRESCALE + 1) / 256.0);

    for (Rpm = 0.0f; Rpm <= 7500.0f; Rpm += 2500.0f)
    {
        SpindleSpeed(Rpm);
        Delay_sec(0.01);
    }

    SpindleSpeed(0.0f);
    FPGA(IO_PWMS + 2 * PWM + 1) = 0;
}
