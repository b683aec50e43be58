// PC-DSP.h - what the PC and the programs on the board have in common.
//
// Counts and limits of the board, numbers of its I/O bits, modes of an axis, the requests a
// program can put to the PC application, and the status record the PC reads.
// Programs include KMotionDef.h, which includes this file.

#ifndef __PCDSP_H
#define __PCDSP_H

// ---- Release and link to the PC ------------------------------------------------------------------------

#define KMOTION_VER         "4.34" // release
#define STAT_VERSION        308    // layout version of MAIN_STATUS
#define HOST_JOB_ACTIVE_BIT 1      // bit mask in HostStatus: a job is running on the PC
#define ABORT_CHAR          0x03   // Control-C: aborts any command on the link
#define N_BYTES_PER_LINE    64     // bytes in one line of a program download

// ---- Time ----------------------------------------------------------------------------------------------

#define TIMEBASE 0.00009 // servo sample period in seconds (90 us)

// ---- Threads and their programs ------------------------------------------------------------------------

#define N_USER_THREADS             7          // number of user threads
#define USER_PROG_ADDRESS_KFLOP    0x80050000 // program address of thread 1
#define MAX_USER_PROG_SIZE_KFLOP   0x10000    // space for a program: thread n starts at base + (n-1)*size
#define USER_PROG_ADDRESS_KMOTION  0x80038000 // the same on the older KMotion board
#define MAX_USER_PROG_SIZE_KMOTION 0x8000     // the same on the older KMotion board

// ---- Axes ----------------------------------------------------------------------------------------------

#define N_CHANNELS    8     // axis channels on a board
#define N_IIR_FILTERS 3     // filters in each axis
#define MAX_SEGMENTS  35000 // entries in the coordinated-motion buffer

// Input modes of an axis (CHAN.InputMode).
#define NO_INPUT_MODE   0 // no position input
#define ENCODER_MODE    1 // quadrature encoder
#define ADC_MODE        2 // analog input
#define RESOLVER_MODE   3 // resolver or sine/cosine encoder
#define USER_INPUT_MODE 4 // position is written by a user program
#define NUM_INPUT_MODES 4 // the highest of them

// Output modes of an axis (CHAN.OutputMode).
#define NO_OUTPUT_MODE     0 // no output
#define MICROSTEP_MODE     1 // stepper driven with sine/cosine currents
#define DC_SERVO_MODE      2 // brushed DC motor
#define BRUSHLESS_3PH_MODE 3 // three-phase brushless motor
#define BRUSHLESS_4PH_MODE 4 // four-phase (two-coil) brushless motor
#define DAC_SERVO_MODE     5 // analog output to an external amplifier
#define STEP_DIR_MODE      6 // open-loop step and direction
#define CL_STEP_DIR_MODE   7 // closed-loop step and direction
#define CL_MICROSTEP_MODE  8 // closed-loop microstepping
#define NUM_SERVO_MODES    8 // the highest of them

// Backlash modes of an axis (CHAN.BacklashMode).
#define BACKLASH_OFF       0 // no backlash compensation
#define BACKLASH_LINEAR    1 // compensation applied at a constant rate
#define NUM_BACKLASH_MODES 1 // the highest of them

// Texts for the modes: what an operator reads, and the name of the constant.
#define TranslateInputMode(x)          \
    (((x) & 0xF) == 0 ? "No Input" :   \
     ((x) & 0xF) == 1 ? "Encoder" :    \
     ((x) & 0xF) == 2 ? "ADC" :        \
     ((x) & 0xF) == 3 ? "Resolver" :   \
     ((x) & 0xF) == 4 ? "User Input" : \
     "Invalid")

#define InputModeToDefine(x)                \
    (((x) & 0xF) == 0 ? "NO_INPUT_MODE" :   \
     ((x) & 0xF) == 1 ? "ENCODER_MODE" :    \
     ((x) & 0xF) == 2 ? "ADC_MODE" :        \
     ((x) & 0xF) == 3 ? "RESOLVER_MODE" :   \
     ((x) & 0xF) == 4 ? "USER_INPUT_MODE" : \
     "Invalid")

#define TranslateOutputMode(x)        \
    (((x) & 0xF) == 0 ? "No Output" : \
     ((x) & 0xF) == 1 ? "Microstep" : \
     ((x) & 0xF) == 2 ? "DC Servo" :  \
     ((x) & 0xF) == 3 ? "3PH Servo" : \
     ((x) & 0xF) == 4 ? "4PH Servo" : \
     ((x) & 0xF) == 5 ? "DAC Servo" : \
     ((x) & 0xF) == 6 ? "Step Dir" :  \
     ((x) & 0xF) == 7 ? "CL Step" :   \
     ((x) & 0xF) == 8 ? "CL Micro" :  \
     "Invalid")

#define OutputModeToDefine(x)                  \
    (((x) & 0xF) == 0 ? "NO_OUTPUT_MODE" :     \
     ((x) & 0xF) == 1 ? "MICROSTEP_MODE" :     \
     ((x) & 0xF) == 2 ? "DC_SERVO_MODE" :      \
     ((x) & 0xF) == 3 ? "BRUSHLESS_3PH_MODE" : \
     ((x) & 0xF) == 4 ? "BRUSHLESS_4PH_MODE" : \
     ((x) & 0xF) == 5 ? "DAC_SERVO_MODE" :     \
     ((x) & 0xF) == 6 ? "STEP_DIR_MODE" :      \
     ((x) & 0xF) == 7 ? "CL_STEP_DIR_MODE" :   \
     ((x) & 0xF) == 8 ? "CL_MICROSTEP_MODE" :  \
     "Invalid")

#define TranslateBacklashMode(x)   \
    (((x) & 0xF) == 0 ? "off" :    \
     ((x) & 0xF) == 1 ? "Linear" : \
     "Invalid")

#define BacklashModeToDefine(x)             \
    (((x) & 0xF) == 0 ? "BACKLASH_OFF" :    \
     ((x) & 0xF) == 1 ? "BACKLASH_LINEAR" : \
     "Invalid")

// ---- Inputs and outputs --------------------------------------------------------------------------------

#define N_DACS      8 // analog outputs
#define N_ADCS      8 // analog inputs
#define N_PWMS      8 // on-board PWM channels
#define N_ENCS      8 // on-board encoder channels
#define N_ADCS_SNAP 8 // analog readings of one SnapAmp
#define N_PWMS_SNAP 4 // PWM channels of one SnapAmp
#define N_ENCS_SNAP 4 // encoder channels of one SnapAmp

// Numbers of the I/O bits.
#define N_BITS               48   // hardware I/O bits of KFLOP (0-47)
#define N_BITS_KMOTION       32   // hardware I/O bits of the older KMotion board
#define N_VIRTUAL_BITS       16   // virtual bits from number 48 (48-63)
#define N_SNAPAMP_BITS0      32   // bits of the first SnapAmp from number 64 (64-95)
#define N_SNAPAMP_BITS1      32   // bits of the second SnapAmp from number 96 (96-127)
#define N_KANALOG_INPUTBITS  16   // Kanalog input bits from number 128 (128-143)
#define N_KANALOG_OUTPUTBITS 24   // Kanalog output bits from number 144 (144-167)
#define KSTEP_OPTO_IN_BITS   168  // first bit number of the multiplexed KStep inputs (168-183)
#define N_KSTEP_INPUTBITS    16   // number of multiplexed KStep inputs
#define VIRTUAL_BITS_EX      1024 // first bit number of the extended virtual bits
#define N_VIRTUAL_BITS_EX    1024 // number of extended virtual bits (1024-2047)

// ---- Conversion of readings ----------------------------------------------------------------------------

// The older KMotion board.
#define FULL_RANGE_VOLTAGE_KMOTION    (-10.0f)   // volts for 2048 counts of analog inputs 0-3
#define OFFSET_VOLTAGE_KMOTION        0.0f       // offset in counts of the same conversion
#define FULL_RANGE_CURRENT_KMOTION    4.85f      // amperes for 4096 counts of analog inputs 4-7
#define OFFSET_CURRENT_KMOTION        (-2048.0f) // offset in counts of the same conversion
#define FULL_RANGE_VOLTAGE_KMOTION_4V (4.0f)     // volts for 4096 counts of the 4 V outputs
// volts of analog inputs 0-3
#define KMOTION_CONVERT_ADC_TO_VOLTS(x) (((x)-OFFSET_VOLTAGE_KMOTION)/2048.0f*FULL_RANGE_VOLTAGE_KMOTION)
// amperes of analog inputs 4-7
#define KMOTION_CONVERT_ADC_TO_AMPS(x) (((x)-OFFSET_CURRENT_KMOTION)/4096.0f*FULL_RANGE_CURRENT_KMOTION)
// volts of the 4 V outputs
#define KMOTION_CONVERT_DAC_TO_VOLTS_4V(x) ((x)/4096.0f*FULL_RANGE_VOLTAGE_KMOTION_4V)

// SnapAmp.
#define FULL_RANGE_CURRENT_SNAP 35.0f   // amperes for 8192 counts
#define OFFSET_CURRENT_SNAP     8192.0f // reading in counts at zero current
#define FULL_RANGE_VOLTAGE_SNAP 102.6f  // volts for 65536 counts
#define OFFSET_VOLTAGE_SNAP     256.0f  // reading in counts at zero volts
// amperes of a reading
#define SNAP_CONVERT_ADC_TO_AMPS(x) (((x)-OFFSET_CURRENT_SNAP)/8192.0f*FULL_RANGE_CURRENT_SNAP)
// reading for amperes, a float
#define SNAP_CONVERT_AMPS_TO_ADC(x) (((x)/FULL_RANGE_CURRENT_SNAP*8192.0f+OFFSET_CURRENT_SNAP))
// volts of a reading
#define SNAP_CONVERT_ADC_TO_VOLTS(x) (((x)-OFFSET_VOLTAGE_SNAP)/65536.0f*FULL_RANGE_VOLTAGE_SNAP)
// reading for volts, an int
#define SNAP_CONVERT_VOLTS_TO_ADC(x) ((int)((x)/FULL_RANGE_VOLTAGE_SNAP*65536.0f+OFFSET_VOLTAGE_SNAP))

// Kanalog.
#define KANALOG_CONVERT_DAC_TO_VOLTS(x) ((x)*(-10.0f/2048.0f)) // output volts of a DAC value, -2048 to 2047
#define KANALOG_CONVERT_ADC_TO_VOLTS(x) ((x)*( 10.0f/2048.0f)) // input volts of an ADC value, -2048 to 2047

// ---- Requests to the PC application --------------------------------------------------------------------

// A program stores a request code in persist.UserData[PC_COMM_PERSIST] and its parameters in the
// elements behind it, called +1, +2, ... here; then it waits until the PC has replaced the code by
// PC_COMM_IDLE, or by a negative number for a failure.
// - (float): the element holds the bytes of a float.
// - text: the element holds where in gather_buffer the text is, counted in words of 32 bits.
// - where from, where to: an index in persist.UserData taken as doubles.
#define PC_COMM_IDLE                   0   // no request; what the PC stores when one has been carried out
#define PC_COMM_ESTOP                  1   // emergency stop
#define PC_COMM_HALT                   2   // halt the job
#define PC_COMM_EXECUTE                3   // start (cycle start)
#define PC_COMM_SINGLE_STEP            4   // run one line
#define PC_COMM_SET_FRO                5   // set the feed override; +1 value (float)
#define PC_COMM_SET_FRO_INC            6   // multiply the feed override; +1 factor (float)
#define PC_COMM_SET_X                  7   // set the X display; +1 value (float)
#define PC_COMM_SET_Y                  8   // set the Y display; +1 value (float)
#define PC_COMM_SET_Z                  9   // set the Z display; +1 value (float)
#define PC_COMM_SET_A                  10  // set the A display; +1 value (float)
#define PC_COMM_SET_B                  11  // set the B display; +1 value (float)
#define PC_COMM_SET_C                  12  // set the C display; +1 value (float)
#define PC_COMM_USER_BUTTON            13  // press a user button; +1 its number
#define PC_COMM_MCODE                  14  // run an M code; +1 its number
#define PC_COMM_MSG                    15  // message box; +1 text, +2 MB_ options, +3 comes back: the
                                           // button
#define PC_COMM_GET_VARS               16  // read interpreter variables; +1 first, +2 count, +3 where to
#define PC_COMM_SET_VARS               17  // write interpreter variables; +1 first, +2 count, +3 where from
#define PC_COMM_MDI                    18  // execute a G-code line; +1 text, +2 comes back: the result
#define PC_COMM_GETAXISRES             19  // counts per inch of six axes, floats; +1 first element to fill
#define PC_COMM_RESTART                20  // rewind the job to its first line
#define PC_COMM_SET_SSO                21  // set the spindle override; +1 value (float)
#define PC_COMM_SET_SSO_INC            22  // multiply the spindle override; +1 factor (float)
#define PC_COMM_GET_TOOLTABLE_LENGTH   23  // read a tool length; +1 tool index, +2 where to
#define PC_COMM_SET_TOOLTABLE_LENGTH   24  // write a tool length; +1 tool index, +2 where from
#define PC_COMM_GET_MISC_SETTINGS      25  // units (1 inch, 2 mm), T, H, D, ints; +1 first element to fill
#define PC_COMM_GET_MACHINE_COORDS     26  // machine coordinates; +1 where to
#define PC_COMM_GET_DROS               27  // displayed coordinates; +1 where to
#define PC_COMM_UPDATE_FIXTURE         28  // take over changed fixture offsets
#define PC_COMM_INPUT                  29  // input box; +1 text, +2 comes back: the value (float), +3: the
                                           // button
#define PC_COMM_GET_TOOLTABLE_DIAMETER 30  // read a tool diameter; +1 tool index, +2 where to
#define PC_COMM_SET_TOOLTABLE_DIAMETER 31  // write a tool diameter; +1 tool index, +2 where from
#define PC_COMM_GET_TOOLTABLE_OFFSETX  32  // read a tool X offset; +1 tool index, +2 where to
#define PC_COMM_SET_TOOLTABLE_OFFSETX  33  // write a tool X offset; +1 tool index, +2 where from
#define PC_COMM_GET_TOOLTABLE_OFFSETY  34  // read a tool Y offset; +1 tool index, +2 where to
#define PC_COMM_SET_TOOLTABLE_OFFSETY  35  // write a tool Y offset; +1 tool index, +2 where from
#define PC_COMM_HALT_NEXT_LINE         36  // halt at the next line of the job
#define PC_COMM_ENABLE_JOG_KEYS        37  // allow jog buttons while a job runs
#define PC_COMM_DISABLE_JOG_KEYS       38  // forbid jog buttons while a job runs
#define PC_COMM_RELOAD_GEOCORRECTION   39  // load the geometric correction file again
#define PC_COMM_GET_JOG_OVERRIDE_X     40  // read the X jog speed override; +1 comes back (float)
#define PC_COMM_GET_JOG_OVERRIDE_Y     41  // read the Y jog speed override; +1 comes back (float)
#define PC_COMM_GET_JOG_OVERRIDE_Z     42  // read the Z jog speed override; +1 comes back (float)
#define PC_COMM_GET_JOG_OVERRIDE_A     43  // read the A jog speed override; +1 comes back (float)
#define PC_COMM_GET_JOG_OVERRIDE_B     44  // read the B jog speed override; +1 comes back (float)
#define PC_COMM_GET_JOG_OVERRIDE_C     45  // read the C jog speed override; +1 comes back (float)
#define PC_COMM_SET_JOG_OVERRIDE_X     46  // set the X jog speed override; +1 value (float)
#define PC_COMM_SET_JOG_OVERRIDE_Y     47  // set the Y jog speed override; +1 value (float)
#define PC_COMM_SET_JOG_OVERRIDE_Z     48  // set the Z jog speed override; +1 value (float)
#define PC_COMM_SET_JOG_OVERRIDE_A     49  // set the A jog speed override; +1 value (float)
#define PC_COMM_SET_JOG_OVERRIDE_B     50  // set the B jog speed override; +1 value (float)
#define PC_COMM_SET_JOG_OVERRIDE_C     51  // set the C jog speed override; +1 value (float)
#define PC_COMM_RECREATE_DIALOG_FACE   52  // rebuild the main screen
#define PC_GET_EDIT_CELL               53  // text of an edit control; +1 element v that names it,
                                           // UserData[v] where the text goes
#define PC_COMM_SET_RRO                54  // set the rapid override; +1 value (float)
#define PC_COMM_SET_RRO_INC            55  // multiply the rapid override; +1 factor (float)
#define PC_COMM_PERSIST                100 // element of persist.UserData that holds the request code
#define N_PC_COMM_PERSIST              8   // elements from there on that every status record carries
#define PC_COMM_SCREEN_SCRIPT          56  // later than 4.34: run a screen script; +1 text
#define PC_COMM_GET_TOOLTABLE_INDEX    57  // later than 4.34: index of a tool; +1 id, +2 element to fill
#define PC_COMM_GET_TOOL_SLOT_ID       115 // later than 4.34: slot and id, ints; +1 first element to fill

// Constant surface speed of a lathe: elements of persist.UserData.
#define PC_COMM_CSS_MODE     110 // 1 = RPM, 2 = constant surface speed
#define PC_COMM_CSS_X_OFFSET 111 // X counts at radius zero (float)
#define PC_COMM_CSS_X_FACTOR 112 // inches of radius for one X count (float)
#define PC_COMM_CSS_S        113 // surface speed in inches/s (float)
#define PC_COMM_CSS_MAX_RPM  114 // upper RPM limit (float)

// Probing with Mach3: elements of persist.UserData.
#define MACH3_PROBE_STATUS_VAR  62 // status of the probe
#define MACH3_PROBE_RESULTS_VAR 50 // first of the results

// ---- Status record -------------------------------------------------------------------------------------

// What the board reports to the PC, 116 words.
typedef struct {
    int VersionAndSize;                    // STAT_VERSION, and in the lower half the words of the record
    int ADC[24];                           // raw readings: 8 on board or Kanalog, then 8 for each SnapAmp
    int DAC[N_DACS];                       // analog outputs
    int PWM[16];                           // 8 on board, then 4 for each SnapAmp
    double Position[N_CHANNELS];           // measured position of each axis
    double Dest[N_CHANNELS];               // destination of each axis
    unsigned char OutputChan0[N_CHANNELS]; // first output channel of each axis
    int InputModes;                        // input modes of axes 0-3, 4 bits an axis
    int InputModes2;                       // input modes of axes 4-7
    int OutputModes;                       // output modes of axes 0-3, 4 bits an axis
    int OutputModes2;                      // output modes of axes 4-7
    int Enables;                           // enabled axes, one bit each
    int AxisDone;                          // axes whose motion is finished, one bit each
    int BitsDirection[2];                  // direction of I/O bits 0-63, 1 = output
    int BitsState[2];                      // state of I/O bits 0-63
    int SnapBitsDirection0;                // directions of SnapAmp 0: bits 16-29, 1 = output
    int SnapBitsDirection1;                // directions of SnapAmp 1: bits 16-29, 1 = output
    int SnapBitsState0;                    // SnapAmp 0: 0-7 differential, 8-15 opto, 16-29 general
    int SnapBitsState1;                    // SnapAmp 1: 0-7 differential, 8-15 opto, 16-29 general
    int KanalogBitsStateInputs;            // state of Kanalog inputs, I/O bits 128-143
    int KanalogBitsStateOutputs;           // state of Kanalog outputs, I/O bits 144-167
    int RunOnStartUp;                      // copy of persist.RunOnStartUp
    int ThreadActive;                      // active threads, one bit each, bit 0 = primary thread
    int StopImmediateState;                // copy of CS0_StoppingState
    double TimeStamp;                      // seconds since power-up
    int PC_comm[N_PC_COMM_PERSIST];        // copy of the request in persist.UserData[100..107]
    int VirtualBits;                       // copy of VirtualBits
    int VirtualBitsEx0;                    // copy of the first word of VirtualBitsEx
} MAIN_STATUS;

#endif // __PCDSP_H
