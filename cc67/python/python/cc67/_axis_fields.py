"""The numeric fields of the board's structure `chan[n]`, so that type checkers know them.

Made by `CC67_WRITE_FIELDS=1 pytest tests/test_stubs.py`; the test fails if it differs from the board's table.
"""


class AxisFields:
    """The attributes of an axis that have the names of C."""

    ChanNumber: int
    """0 to 7."""
    Enable: int
    """Nonzero when the servo is active."""
    InputMode: int
    """Position source, NO_INPUT_MODE to USER_INPUT_MODE."""
    OutputMode: int
    """Output type, NO_OUTPUT_MODE to CL_MICROSTEP_MODE."""
    LimitSwitchOptions: int
    """Bits 0, 1 act on the negative, positive limit; 2, 3 their polarity (1 acts when low); 4-7 the action: 0 disable, 1 forbid drive towards the limit, 2 stop; 8 take the bit numbers from the next two fields, else from bits 16-23 and 24-31."""
    LimitSwitchNegBit: int
    """I/O bit of the negative limit."""
    LimitSwitchPosBit: int
    """I/O bit of the positive limit."""
    MasterAxis: int
    """Axis this one follows, -1 for none."""
    SlaveGain: float
    """Motion for one unit of the master."""
    MaxFollowingError: float
    """A larger position error disables the axis, position units."""
    LastFollowingError: float
    """Latest position error, position units."""
    t: float
    """Seconds inside the present profile state."""
    Dest: float
    """Destination the servo follows, position units."""
    UnfilteredDest: float
    """Destination before the low-pass of coordinated motion, position units."""
    DestOffset: float
    """Added to the destination (injection), position units."""
    Vel: float
    """Speed limit for moves, units/s."""
    Accel: float
    """Acceleration limit for moves, units/s^2."""
    Jerk: float
    """Jerk limit for moves, units/s^3."""
    FFAccel: float
    """Acceleration feed-forward gain."""
    FFVel: float
    """Velocity feed-forward gain."""
    Position: float
    """Measured position, position units."""
    invDistPerCycle: float
    """Cycles per position unit; a cycle is four full steps or one commutation."""
    StepperAmplitude: float
    """Amplitude of microstepping at low speed, PWM counts."""
    Output: float
    """Value last sent out, or the correction of a closed-loop stepper."""
    prev_output: float
    """Output of the previous servo sample."""
    Lead: float
    """Lead compensation for a stepper motor's inductance."""
    last_position: float
    """Measured position of the previous sample."""
    last_dest: float
    """Destination at the start of the previous sample, position units."""
    prev_dest: float
    """Destination at the end of the previous sample, position units."""
    LastNonZeroDir: int
    """Direction of the last real movement: +1, -1, 0 unknown."""
    DirectionOfMotion: int
    """Direction of the present movement: +1, -1, 0 none."""
    last_vel: float
    """Speed of the destination in the previous sample, units/s."""
    x1last: float
    """State of the lead compensation."""
    x2last: float
    """State of the lead compensation."""
    OutputChan0: int
    """First PWM, DAC or step generator channel used by the axis."""
    OutputChan1: int
    """Second PWM channel used by the axis."""
    InputChan0: int
    """First encoder or ADC channel used by the axis."""
    InputChan1: int
    """Second ADC channel used by the axis (resolver)."""
    InputOffset0: float
    """Offset added to input 0 after the gain."""
    InputGain0: float
    """Gain of input 0; negative reverses an encoder."""
    InputOffset1: float
    """Offset added to input 1 after the gain."""
    InputGain1: float
    """Gain of input 1."""
    OutputGain: float
    """Factor applied to the output (negative reverses it)."""
    OutputOffset: float
    """Offset added to the output."""
    CommutationOffset: float
    """Offset added to the position before commutation, position units."""
    last_theta: float
    """Resolver angle of the previous sample."""
    theta_correction: float
    """Correction added to the resolver angle."""
    last_enc: int
    """Low byte of the hardware encoder count at the previous sample."""
    P: float
    """Proportional gain, output units per position unit."""
    I: float
    """Integral gain, output units per position unit and sample."""
    D: float
    """Derivative gain, output units per position unit a sample."""
    MaxI: float
    """Limit of the integrator, output units."""
    MaxErr: float
    """Limit of the error that enters the compensator, position units."""
    integrator: float
    """Present integrator content."""
    MaxOutput: float
    """Limit of the output, output units."""
    DeadBandRange: float
    """Half width of the dead band around zero error, position units."""
    DeadBandGain: float
    """Gain inside the dead band (1 = no dead band)."""
    LastMotionType: int
    """Kind of the last independent motion (LAST_MOTION_...)."""
    LastMotionDest: float
    """Target of the last independent motion, for the resume."""
    ExpMotionVc: float
    """Speed at which the curve of MoveExp begins, units/s."""
    ExpMotionXc: float
    """Distance at which the curve of MoveExp begins, position units."""
    SoftLimitNeg: float
    """Negative soft limit, position units."""
    SoftLimitPos: float
    """Positive soft limit, position units."""
    BacklashMode: int
    """BACKLASH_OFF or BACKLASH_LINEAR."""
    BacklashAmount: float
    """Backlash to compensate, position units."""
    BacklashRate: float
    """Speed at which the compensation is applied, units/s."""
    BacklashDirection: int
    """Direction of the last motion seen by the compensation: +1, -1, 0."""
    PrevBacklashDest: float
    """Destination at which the direction was last decided, position units."""
    Backlash: float
    """Compensation being applied at present, position units."""
