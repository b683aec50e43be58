//@ args: --for 0.5
//@ says: a path ended with KLP set and TauKLP 0, so Dest of its axes is now NaN: set TauKLP = -TIMEBASE / log(KLP) before the path starts
#include "KMotionDef.h"

main()
{
    PARAMETRIC_COEFF *s = &ParametricCoeffs[0];

    ch0->InputMode = ch1->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = ch1->OutputMode = STEP_DIR_MODE;
    DefineCoordSystem(0, 1, -1, -1);
    EnableAxisDest(0, 0);
    EnableAxisDest(1, 0);
    KLP = 0.9;
    CoordSystem0 = NULL;
    ParametricIndex = 0;
    LastCoordSystem0 = s;
    CoordSystem0 = s;
    s->trajectory_mode = TRAJECTORY_LINEAR;
    s->x_axis = 0;
    s->y_axis = 1;
    s->z_axis = s->a_axis = s->b_axis = s->c_axis = s->u_axis = s->v_axis = 255;
    s->t = 0.1;
    s->c = 10.0;
    s->X.c = 100.0;
    s->Y.c = 50.0;
    ParametricCoeffs[1].trajectory_mode = TRAJECTORY_OFF;
    CS0_Flushed = 1;
    CoordSystem0 = s;
    Delay_sec(0.3);
}
