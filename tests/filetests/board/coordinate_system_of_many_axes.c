// Six and eight axes in the coordinate system, and the time base of a path: FRO * 90 us, to be changed by 90 us * 90 us / T
// in a tick; a temporary override is not kept.
//@ prints: 0 1 2 -1 4 5 -1 -1
//@ prints: 7 6 5 4 3 2 1 0
//@ prints: 0.5 0.25, 0.5 in 0.1 s
//@ prints: 0.5 0.25, -0.25 in 0.2 s
#include "KMotionDef.h"

static void show_axes(void)
{
    printf("%d %d %d %d ", CS0_axis_x, CS0_axis_y, CS0_axis_z, CS0_axis_a);
    printf("%d %d %d %d\n", CS0_axis_b, CS0_axis_c, CS0_axis_u, CS0_axis_v);
}

static void show_rates(void)
{
    printf("%g %g, ", CS0_LastFRO, CS0_LastRapidFRO);
    printf("%g in %g s\n", CS0_TimeBaseDesired / 90e-6, 90e-6 * 90e-6 / CS0_TimeBaseDelta);
}

main()
{
    DefineCoordSystem6(0, 1, 2, -1, 4, 5);
    show_axes();
    DefineCoordSystem8(7, 6, 5, 4, 3, 2, 1, 0);
    show_axes();
    SetRapidFROwRate(0.25, 0.3);
    SetFROwRate(0.5, 0.1);
    show_rates();
    SetFROwRateTemp(-0.25, 0.2);
    show_rates();
}
//@ cycles: 68474
