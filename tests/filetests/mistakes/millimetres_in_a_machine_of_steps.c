//@ args: --machine parts/millimetres.toml
//@ says: thread 1 at millimetres_in_a_machine_of_steps.c:14:5 in `main`: Jog: axis 0 can move at 10000 steps per second (OutputGain is 1), and its travel in the machine file is 305 units: units = "mm" (millimetres.toml:3) is only a name. Min, max, start and the places of switches are in the units of the program, here steps
//@ says: thread 1 at millimetres_in_a_machine_of_steps.c:16:5 in `main`: axis 0 runs into the end of its travel at -5 (axis.0.min, millimetres.toml:4): a stepper loses its steps there; min, max and start are in steps, not in mm (millimetres.toml:3)
#include "KMotionDef.h"

main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 10000;
    ch0->Accel = 100000;
    ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    Jog(0, -4000);
    while (!ReadBit(136)) WaitNextTimeSlice();
    Jog(0, 0);
    while (!CheckDone(0)) WaitNextTimeSlice();
    Zero(0);
    Move(0, 40000);
    while (!CheckDone(0)) WaitNextTimeSlice();
}
