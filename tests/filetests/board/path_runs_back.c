// A path that is run back: a second along X, a bit, a second along Y; from the middle of Y back to the beginning, where
// it stands. 1000 units a second, so what is printed is the time base.
//@ prints: forward: X 100 Y 50, bit 1
//@ prints: back: X 50 Y 0, bit 1
//@ prints: at the beginning: X 0 Y 0, time base -9e-05
//@ prints: forward again: X 50 Y 0
#include "KMotionDef.h"

#define UNUSED 255
#define BIT    1040
#define SET    1

PARAMETRIC_COEFF *segment(int mode)
{
    PARAMETRIC_COEFF *s = &ParametricCoeffs[ParametricIndex++];

    s->trajectory_mode = mode;
    s->x_axis = 0;
    s->y_axis = 1;
    s->z_axis = s->a_axis = s->b_axis = s->c_axis = s->u_axis = s->v_axis = UNUSED;
    s->special_param = 0;
    s->t = s->a = s->b = s->c = s->d = 0.0;
    s->X.c = s->X.d = s->Y.c = s->Y.d = 0.0;
    return s;
}

// A second in which p goes from 0 to 1.
PARAMETRIC_COEFF *line(void)
{
    PARAMETRIC_COEFF *s = segment(TRAJECTORY_LINEAR);

    s->t = 1.0;
    s->c = 1.0;
    return s;
}

main()
{
    PARAMETRIC_COEFF *s;
    int i;

    for (i = 0; i < 2; i++) {
        chan[i].InputMode = NO_INPUT_MODE;
        chan[i].OutputMode = STEP_DIR_MODE;
        EnableAxisDest(i, 0);
    }
    DefineCoordSystem(0, 1, -1, -1);
    KLP = 0;
    ClearBit(BIT);
    CoordSystem0 = NULL;
    ParametricIndex = 0;
    LastCoordSystem0 = &ParametricCoeffs[0];

    line()->X.c = 1000;
    s = segment(TRAJECTORY_SPECIAL);
    s->x_axis = SET;
    s->special_param = BIT;
    s = line();
    s->X.d = 1000;
    s->Y.c = 1000;
    segment(TRAJECTORY_OFF);
    CS0_t = CS0_TimeExecuted = 0;
    CS0_TimeBase = CS0_TimeBaseDesired = TIMEBASE;
    CS0_Flushed = TRUE;
    CoordSystem0 = LastCoordSystem0;

    Delay_sec(1.5);
    SetFROwRateTemp(-1, 0);
    printf("forward: X %.0f Y %.0f, bit %d\n", ch0->Dest / 10, ch1->Dest / 10, ReadBit(BIT));
    Delay_sec(1);
    printf("back: X %.0f Y %.0f, bit %d\n", ch0->Dest / 10, ch1->Dest / 10, ReadBit(BIT));
    Delay_sec(1);
    printf("at the beginning: X %.0f Y %.0f, time base %g\n", ch0->Dest, ch1->Dest, CS0_TimeBase);
    SetFROwRateTemp(1, 0);
    Delay_sec(0.5);
    printf("forward again: X %.0f Y %.0f\n", ch0->Dest / 10, ch1->Dest / 10);
    while (CheckDoneBuf() == 0) ;
}
//@ cycles: 129587511
