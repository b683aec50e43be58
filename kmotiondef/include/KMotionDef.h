// KMotionDef.h - the KFLOP board for programs that run on it, release 4.34.
//
// Every function, variable, structure and constant that the firmware offers, by subject.
// Unless a comment says that it waits, a function returns at once. While a function waits, the
// other threads, the servo and the console go on.

#ifndef KMotionDef_h
#define KMotionDef_h

#define KFLOP // this is a KFLOP board ...
#define C6722 // ... with this processor
#define BOARD "KFLOP"

#include "PC-DSP.h"

// ---- Basic types ---------------------------------------------------------------------------------------

#define NULL  0
#define FALSE 0
#define TRUE  1

typedef int BOOL;
typedef int FILE;

#ifndef _SIZE_T
#define _SIZE_T
typedef unsigned int size_t;
#endif

// ---- Time ----------------------------------------------------------------------------------------------

#define CLOCKFREQ 50.0e6 // counting rate of TIMER0 in Hz
#define TIMER0 (*(volatile int *)0x42000010) // free-running 32-bit counter, CLOCKFREQ counts a second

extern volatile double ServoTick;        // servo samples since power-up
extern volatile unsigned int LastTimer0; // TIMER0 at the moment ServoTick was raised

// Seconds since power-up.
double Time_sec(void);
// Waits sec seconds; other threads keep running.
void Delay_sec(double sec);
// Waits until Time_sec() reaches time_sec; other threads keep running.
void WaitUntil(double time_sec);
// Waits for the thread's next time slice and returns the time in seconds.
double WaitNextTimeSlice(void);

// ---- Threads and locks ---------------------------------------------------------------------------------

// Thread numbers are 1 to 7; a lock is an int that starts at 0.
extern int CurrentThread; // thread being executed: 0 the primary one, 1 to 7 user threads

// Starts, or starts again, the program loaded for user thread 1 to 7.
void StartThread(int thread);
// Stops scheduling user thread 1 to 7; a thread may name itself.
void PauseThread(int thread);
// Continues a paused thread where it stopped; 1 if no program is loaded there, else 0.
int ResumeThread(int thread);
// Ends the calling thread, as a return from main does. Does not return.
void ThreadDone(void);
// Takes *mutex for the calling thread; waits while another thread holds it.
void MutexLock(int *mutex);
// Stores 0 in *mutex, whoever holds it.
void MutexUnlock(int *mutex);
// Stores value if *mutex is 0; returns what was there (0: acquired). Uninterruptible.
int TestAndSet(int *mutex, int value);
// *p |= mask, uninterruptible.
void AtomicSet(int *p, int mask);
// *p &= mask, uninterruptible: the mask has ones at the bits to keep.
void AtomicClear(int *p, int mask);

// A function that the firmware calls at every servo sample.
typedef void USERCALLBACK(void);

extern USERCALLBACK *UserCallBack; // called at every servo sample, if not NULL; has to return within
                                   // microseconds

// ---- Console and files of the PC -----------------------------------------------------------------------

#define MAX_STRING           128  // longest console string (bytes)
#define MAX_NSTRINGS         256  // entries in the console queue (power of two)
#define MAX_READ_DISK_LENGTH 1024 // longest line read from a host file

// Formats up to 128 characters for the console; returns the full length. Waits only while the queue is
// full.
int printf(const char *format, ...);
// Formats into s, without a limit; returns the length.
int sprintf(char *s, const char *format, ...);
// Converts the text of _str under a format; returns the number of items converted.
int sscanf(const char *_str, const char *_fmt, ...);
// Queues a string for the console, line by line. Returns 0. Waits only while the queue is full.
int Print(char *s);
// Formats one int for the console. Returns 0.
int PrintInt(char *Format, int v);
// Formats one double for the console. Returns 0.
int PrintFloat(char *Format, double v);
// Opens a text file on the PC ("rt", "wt", "at"). Reading waits for the PC and gives NULL on failure; one
// file each way.
FILE *fopen(const char *path, const char *mode);
// Closes a file on the PC. Returns 0.
int fclose(FILE *f);
// Formats up to 128 characters for a file on the PC. Returns 0.
int fprintf(FILE *f, const char *format, ...);
// Reads the next line, at most n characters, without its end. Waits for the PC; NULL at the end of the
// file.
char *fgets(char *str, int n, FILE *file);
// Reads a line of at most 128 characters and converts it; returns the number of items. Waits for the PC.
int fscanf(FILE *f, const char *format, ...);
// 1 after a read or an opening has failed, else 0.
int feof(FILE *f);

extern volatile int NextAvailIn;                        // write index of the console queue
extern volatile int NextAvailOut;                       // read index of the console queue; equal: empty
extern volatile int read_disk_buffer_status;            // 0 no line yet, 1 arrived, 2 failure, 3 no more
extern char read_disk_buffer[MAX_READ_DISK_LENGTH + 1]; // line from a file of the PC

// ---- User variables and the PC application -------------------------------------------------------------

#define N_USER_DATA_VARS 200 // elements of persist.UserData

// Kept over power-off once flashed.
typedef struct {
    int RunOnStartUp;                         // threads to start at power-up: bit n = thread n, 1 to 7
    unsigned int EntryPoints[N_USER_THREADS]; // entry address of the program in thread index + 1
    int UserData[N_USER_DATA_VARS];           // shared with the PC; also used as floats and doubles
} PERSIST;

extern PERSIST persist;                    // shared with the PC and kept over power-off once flashed
extern volatile int HostStatus;            // state of the PC application; bit 0: a job is running
extern volatile int EditChangeCount;       // raised whenever an edit control of the PC changes
extern int StatusRequestCounter;           // raised with every status request of the PC
extern MAIN_STATUS MainStatus;             // not in the firmware: a use does not link
extern const char VersionAndBuildTime[39]; // board name, firmware version and build time

#define JOB_ACTIVE (HostStatus & HOST_JOB_ACTIVE_BIT) // nonzero while a job runs on the PC

// Options of PC_COMM_MSG, one of each kind, added up: the buttons,
#define MB_OK                0x00000000L // OK
#define MB_OKCANCEL          0x00000001L // OK, Cancel
#define MB_ABORTRETRYIGNORE  0x00000002L // abort, Retry, Ignore
#define MB_YESNOCANCEL       0x00000003L // yes, No, Cancel
#define MB_YESNO             0x00000004L // yes, No
#define MB_RETRYCANCEL       0x00000005L // retry, Cancel
#define MB_CANCELTRYCONTINUE 0x00000006L // cancel, Try, Continue
// the icon,
#define MB_ICONHAND        0x00000010L // stop
#define MB_ICONQUESTION    0x00000020L // question
#define MB_ICONEXCLAMATION 0x00000030L // warning
#define MB_ICONASTERISK    0x00000040L // information
// and the window.
#define MB_APPLMODAL            0x00000000L // modal for the application
#define MB_SYSTEMMODAL          0x00001000L // modal for the system
#define MB_TASKMODAL            0x00002000L // modal for the task
#define MB_NOFOCUS              0x00008000L // box does not take the focus
#define MB_SETFOREGROUND        0x00010000L // box comes to the front
#define MB_DEFAULT_DESKTOP_ONLY 0x00020000L // only on the default desktop
#define MB_TOPMOST              0x00040000L // stays above other windows
#define MB_RIGHT                0x00080000L // right-aligned text

// Results of PC_COMM_MSG: the button that was pressed.
#define IDOK     1
#define IDCANCEL 2
#define IDABORT  3
#define IDRETRY  4
#define IDIGNORE 5
#define IDYES    6
#define IDNO     7

// ---- Digital inputs and outputs ------------------------------------------------------------------------

// Bits 0 to 47 are pins of the board, 48 to 63 and 1024 to 2047 are memory, the others belong to
// option boards.
#define LED0 46
#define LED1 47

// Makes a bit an output (dir nonzero) or an input (0). Bits 0 to 45 and SnapAmp GPIO only.
void SetBitDirection(int bit, int dir);
// 1 if the bit is an output, 0 if it is an input.
int GetBitDirection(int bit);
// Drives an output bit high; of an input it sets the latch that appears when it becomes an output.
void SetBit(int bit);
// Drives an output bit low; of an input it clears the latch that appears when it becomes an output.
void ClearBit(int bit);
// Drives an output bit high if state is nonzero, else low.
void SetStateBit(int bit, int state);
// State of a bit, 0 or 1: an output's own state, an input's pin.
int ReadBit(int bit);

extern int VirtualBits;                           // bits in memory: the low 16 are I/O bits 48 to 63
extern int VirtualBitsEx[N_VIRTUAL_BITS_EX / 32]; // bits in memory: I/O bits 1024 to 2047, 32 a word
extern int BitDirShadow[2];                       // directions of bits 0 to 63, 1 = output
extern int BitDirShadowSnap0;                     // directions of SnapAmp 0, 14 bits, 1 = output
extern int BitDirShadowSnap1;                     // directions of SnapAmp 1, 14 bits, 1 = output

// ---- Analog inputs and outputs -------------------------------------------------------------------------

// Values v are -2048 to 2047; with Kanalog that is 10 V, see KANALOG_CONVERT_... DAC does not
// put parentheses around its argument.
#define DAC(ch, v) DAC_Buffer[ch]=((v-2048)&0xfff) // sets analog output ch to v
#define ADC(ch) (ADC_BufferIn[ch]-2048)            // reading of analog input ch

extern short DAC_Buffer[N_DACS];              // words of the outputs, (v - 2048) & 0xFFF for v
extern int ADC_BufferIn[N_ADCS];              // latest raw conversions, 0 to 4095
extern int ADC_BufferInSnap[2 * N_ADCS_SNAP]; // a board: 4 currents, 2 voltages, 2 temperatures

// Raw conversion of analog input ch, 0 to 4095; the macro ADC(ch) is the usual way.
int ReadADC(int ch);
// Declared, but not in the firmware: a program that calls it does not link. Use DAC(ch, v).
void WriteDAC(int ch, int v);

// Motor currents of the older KMotion board.
#define FULL_RANGE_CURRENT 4.85f // amperes for 4096 counts
// current of an axis in amperes: analog input axis+4
#define MeasuredAxisAmps(axis) ((ADC(axis+4)+2048)*(FULL_RANGE_CURRENT/4096.0f))

// ---- PWM outputs ---------------------------------------------------------------------------------------

#define MAX_PWMR_VALUE 400    // limit of v in WritePWMR
#define MAX_PWM_VALUE  230    // limit of v in WritePWM
#define MAX_PWMC_VALUE 1000   // limit of v in WritePWMC
#define MAXV           230.0f // largest vector magnitude for Write3PH

// Drives PWM channel ch in locked antiphase, v within +/-MAX_PWM_VALUE.
void WritePWM(int ch, int v);
// Drives PWM channel ch in recirculate mode, v within +/-MAX_PWMR_VALUE.
void WritePWMR(int ch, int v);
// Commands the current loop of PWM channel ch (SnapAmp), v within +/-MAX_PWMC_VALUE.
void WritePWMC(int ch, int v);

extern int LastPWM[N_PWMS + 2 * N_PWMS_SNAP]; // last words sent: 8 on board, then 4 for each SnapAmp

// ---- Axes ----------------------------------------------------------------------------------------------

// Position units are counts or steps, output units are counts of the PWM or DAC in use.
#define TRAJECTORY_OFF         0 // end of list, no motion
#define TRAJECTORY_INDEPENDENT 1 // third-order profile of one axis
#define TRAJECTORY_LINEAR      2 // coordinated linear segment: x = c*p+d
#define TRAJECTORY_CIRCULAR    3 // coordinated circular segment: x = c*sin(p*a+b)+d
#define TRAJECTORY_SPECIAL     4 // buffered command in the coordinated-motion buffer
#define TRAJECTORY_EXPONENTIAL 5 // exponential approach: a = ratio per tick, b = destination

#define LAST_MOTION_JOG   0 // jog
#define LAST_MOTION_MOVE  1 // move of a single axis
#define LAST_MOTION_MULTI 2 // rapid move of several axes
#define LAST_MOTION_EXP   3 // MoveExp

#define MAX_TRIP 20 // states in the coefficient list of one axis

// One state of a profile: a*t^3 + b*t^2 + c*t + d, or exponential: a ratio per tick, b destination.
typedef struct {
    int trajectory_mode; // TRAJECTORY_OFF, _INDEPENDENT or _EXPONENTIAL
    double t;            // duration of the state in seconds
    double a;            // coefficient of t^3, units/s^3 (one sixth of the jerk)
    double b;            // coefficient of t^2, units/s^2 (half of the starting acceleration)
    double c;            // coefficient of t, units/s (starting velocity)
    double d;            // position at the start of the state, position units
} TRIP_COEFF;

// Second-order filter, output = B0*x + B1*x(-1) + B2*x(-2) + A1*y(-1) + A2*y(-2).
typedef struct {
    float A1; // weight of the output one sample back
    float A2; // weight of the output two samples back
    float B0; // weight of the present input
    float B1; // weight of the input one sample back
    float B2; // weight of the input two samples back
    float d0; // first delay value (filter state)
    float d1; // second delay value (filter state)
} IIR;

// One axis.
typedef struct {
    int ChanNumber;            // 0 to 7
    int Enable;                // nonzero when the servo is active
    int InputMode;             // position source, NO_INPUT_MODE to USER_INPUT_MODE
    int OutputMode;            // output type, NO_OUTPUT_MODE to CL_MICROSTEP_MODE
    int LimitSwitchOptions;    // bits 0, 1 act on the negative, positive limit; 2, 3 their polarity (1 acts
                               // when low); 4-7 the action: 0 disable, 1 forbid drive towards the limit, 2
                               // stop; 8 take the bit numbers from the next two fields, else from bits
                               // 16-23 and 24-31
    int LimitSwitchNegBit;     // I/O bit of the negative limit
    int LimitSwitchPosBit;     // I/O bit of the positive limit
    int MasterAxis;            // axis this one follows, -1 for none
    double SlaveGain;          // motion for one unit of the master
    double MaxFollowingError;  // a larger position error disables the axis, position units
    double LastFollowingError; // latest position error, position units
    double t;                  // seconds inside the present profile state
    double Dest;               // destination the servo follows, position units
    double UnfilteredDest;     // destination before the low-pass of coordinated motion, position units
    double DestOffset;         // added to the destination (injection), position units
    float Vel;                 // speed limit for moves, units/s
    float Accel;               // acceleration limit for moves, units/s^2
    float Jerk;                // jerk limit for moves, units/s^3
    float FFAccel;             // acceleration feed-forward gain
    float FFVel;               // velocity feed-forward gain
    double Position;           // measured position, position units
    double invDistPerCycle;    // cycles per position unit; a cycle is four full steps or one commutation
    float StepperAmplitude;    // amplitude of microstepping at low speed, PWM counts
    float Output;              // value last sent out, or the correction of a closed-loop stepper
    float prev_output;         // output of the previous servo sample
    float Lead;                // lead compensation for a stepper motor's inductance
    TRIP_COEFF *pcoeff;        // profile state being executed, NULL for none
    double last_position;      // measured position of the previous sample
    double last_dest;          // destination at the start of the previous sample, position units
    double prev_dest;          // destination at the end of the previous sample, position units
    int LastNonZeroDir;        // direction of the last real movement: +1, -1, 0 unknown
    int DirectionOfMotion;     // direction of the present movement: +1, -1, 0 none
    float last_vel;            // speed of the destination in the previous sample, units/s
    float x1last;              // state of the lead compensation
    float x2last;              // state of the lead compensation
    int OutputChan0;           // first PWM, DAC or step generator channel used by the axis
    int OutputChan1;           // second PWM channel used by the axis
    int InputChan0;            // first encoder or ADC channel used by the axis
    int InputChan1;            // second ADC channel used by the axis (resolver)
    float InputOffset0;        // offset added to input 0 after the gain
    float InputGain0;          // gain of input 0; negative reverses an encoder
    float InputOffset1;        // offset added to input 1 after the gain
    float InputGain1;          // gain of input 1
    float OutputGain;          // factor applied to the output (negative reverses it)
    float OutputOffset;        // offset added to the output
    float CommutationOffset;   // offset added to the position before commutation, position units
    float last_theta;          // resolver angle of the previous sample
    float theta_correction;    // correction added to the resolver angle
    signed char last_enc;      // low byte of the hardware encoder count at the previous sample
    float P;                   // proportional gain, output units per position unit
    float I;                   // integral gain, output units per position unit and sample
    float D;                   // derivative gain, output units per position unit a sample
    float MaxI;                // limit of the integrator, output units
    float MaxErr;              // limit of the error that enters the compensator, position units
    float integrator;          // present integrator content
    float MaxOutput;           // limit of the output, output units
    float DeadBandRange;       // half width of the dead band around zero error, position units
    float DeadBandGain;        // gain inside the dead band (1 = no dead band)
    int LastMotionType;        // kind of the last independent motion (LAST_MOTION_...)
    double LastMotionDest;     // target of the last independent motion, for the resume
    float ExpMotionVc;         // speed at which the curve of MoveExp begins, units/s
    float ExpMotionXc;         // distance at which the curve of MoveExp begins, position units
    float SoftLimitNeg;        // negative soft limit, position units
    float SoftLimitPos;        // positive soft limit, position units
    int BacklashMode;          // BACKLASH_OFF or BACKLASH_LINEAR
    float BacklashAmount;      // backlash to compensate, position units
    float BacklashRate;        // speed at which the compensation is applied, units/s
    int BacklashDirection;     // direction of the last motion seen by the compensation: +1, -1, 0
    float PrevBacklashDest;    // destination at which the direction was last decided, position units
    float Backlash;            // compensation being applied at present, position units
    TRIP_COEFF *c;             // profile coefficients: the axis' row of TripCoeffs
    IIR iir[N_IIR_FILTERS];    // filters in the servo path
} CHAN;

extern CHAN chan[N_CHANNELS];                       // the eight axes
extern CHAN *ch0;                                   // axis 0
extern CHAN *ch1;                                   // axis 1
extern CHAN *ch2;                                   // axis 2
extern CHAN *ch3;                                   // axis 3
extern CHAN *ch4;                                   // axis 4
extern CHAN *ch5;                                   // axis 5
extern CHAN *ch6;                                   // axis 6
extern CHAN *ch7;                                   // axis 7
extern TRIP_COEFF TripCoeffs[N_CHANNELS][MAX_TRIP]; // profiles of independent moves; chan[n].c is row n
extern double ResolverFactor;                       // position units per radian of resolver angle

// Enabling.

// Turns an axis on where it is: the destination becomes the measured position.
void EnableAxis(int ch);
// Turns an axis on with destination Dest in position units, filters reset, no profile running.
void EnableAxisDest(int ch, double Dest);
// Turns an axis off: feedback stops, the output goes to zero.
void DisableAxis(int ch);
// Makes the present place zero: measured position and destination become 0.
void Zero(int ch);
// Clears the filter delays, integrator and output of an axis; use before enabling or after new
// coefficients.
void ResetFilters(int ch);

// Moving; distances in position units, speeds in units/s.

// Starts a move to position x under the axis' Vel, Accel and Jerk. Poll CheckDone.
void Move(int ch, double x);
// Starts a move by dx from the present destination. Poll CheckDone.
void MoveRel(int ch, double dx);
// Starts a move to position x with at most MaxVel units/s. Poll CheckDone.
void MoveAtVel(int chno, double x, float MaxVel);
// Starts a move by x from the present destination with at most MaxVel units/s.
void MoveRelAtVel(int chno, double x, float MaxVel);
// Starts an exponential approach to x with time constant Tau seconds.
void MoveExp(int chno, double x, double Tau);
// Runs an axis at vel units/s, signed; 0 brings it to a stop under Accel and Jerk.
void Jog(int ch, double vel);
// Starts independent moves of the coordinate system's six axes. Poll CheckDoneXYZABC.
void MoveXYZABC(double x, double y, double z, double a, double b, double c);
// 1 when no profile is running, 0 while one is, -1 when the axis is disabled.
int CheckDone(int ch);
// CheckDone over all axes of the coordinate system: 1 all finished, 0 some moving, -1 one disabled.
int CheckDoneXYZABC(void);

// Building profiles by hand.

// Computes the profile From..To with at most MaxVel into the list of ch from entry CoeffOffset on; stores
// the number of states in *Nstates.
void SetupForMove(
    double From, double To, float MaxVel, CHAN *ch, int CoeffOffset, int NoJerkControlAtStart, int
    NoJerkControlAtEnd, int Start, int *Nstates);
// Puts a hold at x for time seconds into entry CoeffOffset of the list of ch.
void SetupForMotionPause(double x, CHAN *ch, int CoeffOffset, double time);
// Puts the end of motion into entry CoeffOffset of the list of ch.
void SetupForMotionEnd(CHAN *ch, int CoeffOffset);
// Starts the profile prepared in the coefficient list of axis ch.
void StartMove(int ch);
// Drops the running profile; the destination stays where it is.
void StopMotion(CHAN *ch);

// Commutation.

// Applies a vector of v PWM counts at a commutation angle in cycles to the three-phase outputs of an axis.
void Write3PH(CHAN *ch0, float v, double angle_in_cycles);
// Applies a vector of v PWM counts at a commutation angle in cycles to the four-phase outputs of an axis.
void Write4PH(CHAN *ch0, float v, double angle_in_cycles);
// Computes the resolver angle from sine and cosine readings and updates the axis' Position.
void DoResolverInput2(CHAN *chx, float x, float y);

// ---- Coordinated motion --------------------------------------------------------------------------------

// A segment's parameter p runs from 0 to 1 while the motion passes it.

// Linear c*p + d, or circular c*sin(p*a + b) + d.
typedef struct {
    double a; // angle span in radians, circular only
    double b; // start angle in radians, circular only
    double c; // linear: change of position; circular: radius. Position units
    double d; // linear: start position; circular: centre. Position units
} TRIP_CIRCLE_LINEAR;

// Linear: c*p + d.
typedef struct {
    double c; // change of position, position units
    double d; // start position, position units
} TRIP_LINEAR;

// One segment, p(t) = a*t^3 + b*t^2 + c*t + d, or a buffered command.
typedef struct {
    char trajectory_mode; // TRAJECTORY_OFF, _LINEAR, _CIRCULAR or _SPECIAL
    unsigned char x_axis; // axis driven as X; in a TRAJECTORY_SPECIAL entry its command: 0, 1 clear or set
                          // the bit, 2, 3 hold until it is low or high, 4, 5 begin or end a rapid traverse
    unsigned char y_axis; // axis driven as Y
    unsigned char z_axis; // axis driven as Z
    unsigned char a_axis; // axis driven as A
    unsigned char b_axis; // axis driven as B
    unsigned char c_axis; // axis driven as C
    unsigned char u_axis; // axis driven as U
    unsigned char v_axis; // axis driven as V
    short special_param;  // I/O bit of a TRAJECTORY_SPECIAL entry
    double t;             // duration of the segment in seconds
    double a;             // coefficient of t^3 in p(t), 1/s^3
    double b;             // coefficient of t^2 in p(t), 1/s^2
    double c;             // coefficient of t in p(t), 1/s
    double d;             // constant term of p(t)
    TRIP_CIRCLE_LINEAR X; // coordinate X
    TRIP_CIRCLE_LINEAR Y; // coordinate Y
    TRIP_LINEAR Z;        // coordinate Z
    TRIP_LINEAR A;        // coordinate A
    TRIP_LINEAR B;        // coordinate B
    TRIP_LINEAR C;        // coordinate C
    TRIP_LINEAR U;        // coordinate U
    TRIP_LINEAR V;        // coordinate V
} PARAMETRIC_COEFF;

// Which axis is which coordinate.

// Assigns the axes used as x, y, z, a; -1 leaves one unused. b, c, u, v keep theirs.
void DefineCoordSystem(int axisx, int axisy, int axisz, int axisa);
// Assigns the axes used as x, y, z, a, b, c; -1 leaves one unused. u, v keep theirs.
void DefineCoordSystem6(int axisx, int axisy, int axisz, int axisa, int axisb, int axisc);
// Assigns the axes used as x, y, z, a, b, c, u, v; -1 leaves one unused.
void DefineCoordSystem8(
    int axisx, int axisy, int axisz, int axisa, int axisb, int axisc, int axisu, int axisv);

extern int CS0_axis_x; // axis used as X, -1 for none
extern int CS0_axis_y; // axis used as Y, -1 for none
extern int CS0_axis_z; // axis used as Z, -1 for none
extern int CS0_axis_a; // axis used as A, -1 for none
extern int CS0_axis_b; // axis used as B, -1 for none
extern int CS0_axis_c; // axis used as C, -1 for none
extern int CS0_axis_u; // axis used as U, -1 for none
extern int CS0_axis_v; // axis used as V, -1 for none

// The buffer of segments.
extern PARAMETRIC_COEFF *ParametricCoeffs;     // start of the buffer of MAX_SEGMENTS entries
extern PARAMETRIC_COEFF *ParametricCoeffsEnd;  // first address behind the buffer
extern int ParametricIndex;                    // entry the next segment or command will be put into
extern BOOL ParametricIndexWrapped;            // nonzero once new segments overwrite old ones
extern PARAMETRIC_COEFF *CoordSystem0;         // segment being executed, NULL for none
extern PARAMETRIC_COEFF *LastCoordSystem0;     // last segment executed when motion ended
extern PARAMETRIC_COEFF *LastValidTrajSegment; // last segment that produced motion
extern BOOL CS0_Flushed;                       // nonzero: running out of segments is the end
extern BOOL CS0_HoldAtEnd;                     // nonzero: hold at the end of the buffer, do not end
extern BOOL CS0_DoingRapid;                    // nonzero in a rapid traverse

// Call after writing ParametricCoeffs[ParametricIndex]: advances the index and accounts for the time.
void IncParametricIndex(void);
// Buffered motion: 1 finished, 0 running, -1 an axis of the coordinate system is disabled.
int CheckDoneBuf(void);

// Time along the path.
extern double CS0_t;               // seconds inside the segment being executed
extern double CS0_TimeExecuted;    // seconds of all segments completed
extern double CS0_TimeDownloaded;  // seconds of all segments put into the buffer
extern double CS0_TimeLost;        // seconds of segments already overwritten
extern double CS0_TimeBase;        // seconds that motion advances in a tick, negative backwards
extern double CS0_TimeBaseDesired; // what CS0_TimeBase is being ramped to, seconds a tick
extern double CS0_TimeBaseDelta;   // largest change of CS0_TimeBase in a tick, seconds

// Feed override and rapid override.

// Ramps the feed override to FRO (1.0 real time, 0 stopped, negative backwards).
void SetFRO(float FRO);
// Ramps the rapid override to FRO.
void SetRapidFRO(float FRO);
// Ramps the feed override even during a feedhold and does not keep the value for the resume.
void SetFROTemp(float FRO);
// SetFRO with DecelTime seconds for the whole way from 1.0 to 0.0.
void SetFROwRate(float FRO, float DecelTime);
// SetRapidFRO with DecelTime seconds for the whole way from 1.0 to 0.0.
void SetRapidFROwRate(float FRO, float DecelTime);
// SetFROTemp with DecelTime seconds for the whole way from 1.0 to 0.0.
void SetFROwRateTemp(float FRO, float DecelTime);
// Seconds from full override to standstill, from the limits of all axes in the coordinate system.
float GetNominalFROChangeTime(void);

extern float CS0_LastFRO;      // feed override last requested; applies when a feedhold is released
extern float CS0_LastRapidFRO; // rapid override last requested; applies when a feedhold is released

// Feedhold.

// Feedhold: brings the coordinate system's axes to a controlled stop. See CS0_StoppingState.
void StopCoordinatedMotion(void);
// Releases a feedhold and continues the interrupted motion.
void ResumeCoordinatedMotion(void);
// Drops the feedhold without continuing the interrupted motion.
void ClearStopImmediately(void);
// Recomputes CS0_StoppingState; needed only while independent moves are being stopped.
void UpdateStoppingState(void);

extern int CS0_StoppingState;  // 0 none, 1 stopping, 3 stopped; 2, 4 the same for independent motion
extern float CS0_DecelTime;    // seconds to a stop, computed when a feedhold begins
extern float CS0_NomDecel2TB2; // nominal deceleration time over 2*TIMEBASE^2

// Path smoothing.
extern double KLP;            // low-pass on destinations: exp(-TIMEBASE / Tau), 0 for none
extern float TauKLP;          // time constant that belongs to KLP, seconds
extern float SplineTauFactor; // duration of the final spline in multiples of TauKLP

// ---- Spindle -------------------------------------------------------------------------------------------

// Spindle measurement and threading.
typedef struct {
    double Position;           // spindle position in revolutions
    double StartPosition;      // position in revolutions at which threading motion begins
    double LastUpdatePosition; // position in revolutions at the last speed computation
    double RevsPerCount;       // revolutions for one encoder count
    double UpdateTick;         // servo tick at which the speed is computed next
    double DeltaTicks;         // servo ticks between speed computations
    double AdjTimeFilt;        // filtered time of the motion, corrected for the lag, seconds
    double LastCSTime;         // coordinate-system time of the previous sample, seconds
    double *pEncoderPos;       // address of the position used as spindle encoder
    double K;                  // low-pass coefficient that belongs to Tau
    float TrueSpeedRPS;        // measured speed, revolutions/s
    float InvBaseSpeedRPS;     // reciprocal of the speed the trajectory was planned for, s/rev
    double InvBaseSpeedRPSK1;  // InvBaseSpeedRPS*(1-K)
    float InvUpdateTime;       // reciprocal of the speed update time, 1/s
    float Tau;                 // time constant of the spindle filter, seconds
    int Type;                  // 0 no spindle feedback, 1 encoder
    int ThreadingActive;       // nonzero while threading is in progress
} SPINDLE;

extern SPINDLE Spindle; // spindle measurement and threading

// Sets up spindle measurement: Type 0 none, 1 encoder; Axis the channel read; update time and Tau in
// seconds.
void ConfigureSpindle(int Type, int Axis, float UpdateTimeSecs, float Tau, float CountsPerRev);
// Starts buffered motion slaved to the spindle, planned for BaseSpeedRPS revolutions/s.
void TrigThreading(float BaseSpeedRPS);

// ---- Data recorder -------------------------------------------------------------------------------------

#define MAX_GATHER_VALUES 32      // entries in gather.list
#define MAX_GATHER_DATA   1000000 // doubles in gather_buffer
#define N_CPLX            2048    // points of the Bode work buffer input

// What is recorded: GATHER_VALUE_DEF.type.
#define GATHER_END_TYPE      0 // end of list
#define GATHER_INT_TYPE      1 // 32-bit integer, stored as a double
#define GATHER_LASTPWM_TYPE  2 // LastPWM word, stored as value - 1280
#define GATHER_LASTPWMC_TYPE 3 // LastPWM word in current mode, stored as value - 41984
#define GATHER_FLOAT_TYPE    4 // float, stored as a double
#define GATHER_DOUBLE_TYPE   5 // double
#define GATHER_ADC_TYPE      6 // analog word, stored as ((unsigned)word >> 20) - 2048
#define GATHER_NULL_TYPE     7 // nothing sampled, 0.0 stored

// One quantity that is recorded.
typedef struct {
    int type;   // GATHER_ ... _TYPE; 0 ends the list
    void *addr; // what is sampled at each servo tick
} GATHER_VALUE_DEF;

// The data recorder: at each servo tick, while bufptr is below endptr, one double is stored for every entry
// of the list.
typedef struct {
    double *bufptr;                           // next place to store; recording goes on below endptr
    double *endptr;                           // end of recording
    double Dest;                              // reference destination for injection, position units
    int Inject;                               // nonzero: list[0] is set from bufptr, recording begins at
                                              // list[1]
    GATHER_VALUE_DEF list[MAX_GATHER_VALUES]; // what is recorded at each tick, ended by type 0
} GATHER;

extern GATHER gather;         // descriptor of the data recorder, which runs at every servo tick
extern double *gather_buffer; // MAX_GATHER_DATA doubles: recordings, and texts and data for the PC
extern float *input;          // work buffer of N_CPLX floats for Bode measurements

// Prepares recording of six doubles a tick of axis c for n_Samples ticks; TriggerGather starts it.
void SetupGatherAllOnAxis(int c, int n_Samples);
// Starts recording into gather_buffer. Poll CheckDoneGather.
void TriggerGather(void);
// 1 when recording has reached its end, else 0.
int CheckDoneGather(void);

// ---- FPGA registers ------------------------------------------------------------------------------------

#define FPGA_ADDR  ((volatile unsigned char *)0x91000000)      // for bytes
#define FPGA_ADDRW ((volatile unsigned short int *)0x91000000) // for 16-bit words
#define FPGA(X) (FPGA_ADDR[(X)*4+2])   // byte register X, readable and assignable
#define FPGAW(X) (FPGA_ADDRW[(X)*2+1]) // 16-bit register X, readable and assignable

// I/O bits: eight bits a register.
#define BIT_SET  0x100 // 1<<(n%8) to FPGA(BIT_SET+n/8) sets bit n
#define BIT_CLR  0x110 // ~(1<<(n%8)) to FPGA(BIT_CLR+n/8) clears bit n: zeros clear
#define BIT_DIR  0x120 // directions, 1 = output
#define BIT_READ 0x130 // states

// Encoder inputs.
#define ENC_NOISE_FILTER_ADD         0x05  // filter length 0-255 and the two bits below (FPGAW)
#define ENC_0_3_JP4                  0x200 // encoders 0-3 on JP4 instead of JP7
#define ENC_4_7_JP6                  0x100 // encoders 4-7 on JP6 instead of JP5
#define ENC_NOISE_FILTER_DEFAULT_VAL 7     // default filter length
#define ENC_NOISE_ERR_ADD            0x08  // register of the error bits
#define ENC_NOISE_ERR_BIT0           4     // position of the error bit of encoder 0,
#define ENC_NOISE_ERR_BIT1           5     // encoder 1,
#define ENC_NOISE_ERR_BIT2           6     // encoder 2,
#define ENC_NOISE_ERR_BIT3           7     // encoder 3

// Step generators.
#define NSTEPDIR                  8    // generators of step and direction
#define STEP_PULSE_LENGTH_ADD     0x06 // bits 0-5 length / 60 ns, 6: JP4 and JP6, 7: pulses high
#define STEP_PULSE_LENGTH_DEFAULT 32   // about 2 us, stored at power-up
#define STEP_RATE_ADD             0x3c // 4 bytes, low first: 23-0 rate, 26-24 generator, 27 drive, 31
                                       // enable
#define STEP_POSITION_ADD0        0x40 // steps of generator 0: 9 bits and 7 fraction bits (FPGAW)
#define STEP_POSITION_ADD1        0x42 // generator 1
#define STEP_POSITION_ADD2        0x44 // generator 2
#define STEP_POSITION_ADD3        0x46 // generator 3
#define STEP_POSITION_ADD4        0x48 // generator 4
#define STEP_POSITION_ADD5        0x4a // generator 5
#define STEP_POSITION_ADD6        0x4c // generator 6
#define STEP_POSITION_ADD7        0x4e // generator 7

// PWM on I/O bits 26 to 33.
#define N_IO_PWMS        8    // generators
#define IO_PWMS          0xD0 // generator k: value 0-255 in IO_PWMS+2*k, enable in bit 0 of the next
#define IO_PWMS_PRESCALE 0x2f // clock of all generators: 16.67 MHz/(value+1)
#define IO_PWM_MAX_VALUE 255  // value for 100 % duty

// ---- UART ----------------------------------------------------------------------------------------------

#define RS232_STATUS        0xc1                     // FPGA register: status
#define RS232_DATA          0xc0                     // FPGA register: data, read and write
#define RS232_DATA_READY    0x01                     // status bit: a character waits
#define RS232_TRANSMIT_FULL 0x02                     // status bit: transmitter full
#define RS232_BAUD_REG      0xc1                     // FPGA register, write: divisor
#define RS232_BAUD_115200   ((16666666/115200/16)-1) // divisors
#define RS232_BAUD_57600    ((16666666/57600/16)-1)
#define RS232_BAUD_38400    ((16666666/38400/16)-1)
#define RS232_BAUD_19200    ((16666666/19200/16)-1)
#define RS232_BAUD_9600     ((16666666/9600/16)-1)
#define RS232_BAUD_4800     ((16666666/4800/16)-1)
#define RS232BUFSZ          1000                     // bytes in each ring

// Enables the UART pins and sets the divisor, one of the RS232_BAUD_ values. Takes about 2 ms.
void InitRS232(int baud);
// InitRS232, then empties both rings and connects the command interpreter (DoRS232Cmds = 1). Takes about 2
// ms.
void EnableRS232Cmds(int baud);
// Takes the next received character; waits while there is none.
char RS232_GetChar(void);
// Sends a character; waits while the transmit ring is full.
void RS232_PutChar(char c);

extern volatile int DoRS232Cmds;     // nonzero: characters go to the command interpreter
extern char * volatile pRS232RecIn;  // write position in the receive ring, moved by the firmware
extern char *pRS232RecOut;           // read position in the receive ring; equal: empty
extern char *pRS232TxIn;             // write position in the transmit ring
extern char * volatile pRS232TxOut;  // read position in the transmit ring, moved by the firmware
extern char RS232RecBuf[RS232BUFSZ]; // receive ring
extern char RS232TxBuf[RS232BUFSZ];  // transmit ring

// ---- Kanalog and KStep option boards -------------------------------------------------------------------

#define KAN_TRIG_REG    0xA0 // 1 enables Kanalog, 2 the UART pins, 3 both
#define KAN_DAC_REGS    0x80 // first of 8 analog outputs (FPGAW)
#define KAN_FET_OPTO    0x88 // FET drivers in the high byte, opto outputs in the low byte (FPGAW)
#define KAN_GPOUT       0x89 // 8 general outputs
#define KAN_ADC_REGS    0x90 // first of 8 analog inputs (FPGAW)
#define KAN_OPTOIN_GPIN 0x98 // opto inputs in the high byte, general inputs in the low byte (FPGAW)
#define KAN_INPUTS      128  // first input bit: 128-135 general, 136-143 opto
#define KAN_NINPUTS     16   // input bits
#define KAN_OUTPUTS     144  // first output bit: 144-151 opto, 152-159 FET, 160-167 general
#define KAN_NOUTPUTS    24   // output bits

extern int KanalogPresent;             // 1 when a Kanalog was found at power-up
extern int DisableKanalogDetectOnBoot; // nonzero, flashed: JP4 is not probed at power-up
extern int KStepPresent;               // set by a program: KStep inputs become bits 168 to 183

// ---- Konnect option boards -----------------------------------------------------------------------------

// Prepares the AUX port for Konnect boards and empties the list of boards served.
void InitAux(void);
// Serves a Konnect board on AUX1 from now on: 16 outputs from *OutputAddress, 32 inputs to *InputAddress.
void AddKonnect(int BoardAddress, int *OutputAddress, int *InputAddress);
// AddKonnect for a board on AUX0.
void AddKonnect_Aux0(int BoardAddress, int *OutputAddress, int *InputAddress);

// ---- SnapAmp option boards -----------------------------------------------------------------------------

// Writes a 16-bit word to SnapAmp register add (SNAP0 or SNAP1 plus a SNAP_ number).
void WriteSnapAmp(int add, int data);
// Reads a 16-bit word from SnapAmp register add (SNAP0 or SNAP1 plus a SNAP_ number).
int ReadSnapAmp(int add);

extern int SnapAmpPresent;             // SnapAmp boards found at power-up
extern int DisableSnapAmpDetectOnBoot; // nonzero, flashed: JP7 is not probed at power-up

// Registers; some numbers mean one thing when written and another when read.
#define SNAP0                  0x40 // base of SnapAmp 0
#define SNAP1                  0x60 // base of SnapAmp 1
#define SNAP_PWMS              0    // 4 PWM registers, 16 bits (write and read)
#define SNAP_CLR_ENC_ERRS      8    // write: any value clears all encoder errors
#define SNAP_CUR_LOOP_GAINS    9    // write: 4 current-loop gains, 8 bits, default 16
#define SNAP_SET_BIT           17   // write: sets the marked ones of 14 I/O bits
#define SNAP_CLR_BIT           18   // write: clears the marked ones of 14 I/O bits
#define SNAP_DIR_BIT           19   // write: directions of 14 I/O bits
#define SNAP_SUPPLY_CLAMP0     20   // write: supply clamp level, side A
#define SNAP_SUPPLY_CLAMP_ENA0 21   // write: supply clamp enable, side A
#define SNAP_SUPPLY_CLAMP1     22   // write: supply clamp level, side B
#define SNAP_SUPPLY_CLAMP_ENA1 23   // write: supply clamp enable, side B
#define SNAP_PEAK_CUR_LIMIT0   24   // write: peak current limit, 4 bits, side A
#define SNAP_PEAK_CUR_LIMIT1   25   // write: peak current limit, 4 bits, side B
#define SNAP_ENC               8    // read: 4 encoders, bit 15 error, bits 7-0 count
#define SNAP_CURRENT_A0        12   // read: current side A lead A (14 bits)
#define SNAP_CURRENT_C0        13   // read: current side A lead C
#define SNAP_CURRENT_A1        14   // read: current side B lead A
#define SNAP_CURRENT_C1        15   // read: current side B lead C
#define SNAP_DIFF_IN           16   // read: bits 15-8 differential inputs, 7-0 encoder inputs
#define SNAP_IN_BIT            17   // read: 14 I/O bits
#define SNAP_SUPPLY_VOLT0      22   // read: supply voltage side A
#define SNAP_SUPPLY_VOLT1      23   // read: supply voltage side B
#define SNAP_TEMP0             24   // read: temperature side A
#define SNAP_TEMP1             25   // read: temperature side B
#define SNAP_STATUS            30   // read: fan, over-temperature 1, 0, over-current 1, 0, fault
#define SNAP_RESET             31   // resets

// The link to the boards.
#define KM_SNAP_READ_LOW        0xc  // low byte of a read
#define KM_SNAP_READ_HI         0xd  // high byte of a read
#define KM_SNAP_READ_EXCEPTION  0x10 // read exception
#define KM_SNAP_CLK_ENA         0x09 // clock enable
#define KM_SNAP_SHIFT_BYTE      0x0a // byte to shift out
#define KM_SNAP_WRITE_HIGH_TRIG 0x0b // high byte of a write, starts it
#define KM_SNAP_READ_ADD_TRIG   0x0c // address of a read, starts it
#define KM_SNAP_READ_ADD_BITMAP 0x28 // read address bitmap

// ---- Memory and flash ----------------------------------------------------------------------------------

#define IRAM             ((volatile char *)0x10000000) // on-chip memory
#define SDRAM            ((volatile char *)0x80000000) // 16 MiB
#define FLASH            ((volatile char *)0x90000000) // the first megabyte belongs to the system
#define FLASH_USER       ((volatile char *)0x90100000) // the second megabyte is free for users
#define FLASH_BLOCK_SIZE (0x10000)                     // bytes that an erase covers

// Erases and writes Length 16-bit words of flash, printing progress after message. Waits; 0 = success.
int ProgramFlash(volatile char *src, int Length, volatile char *dest, char *message);
// ProgramFlash without console output. Waits; 0 = success.
int ProgramFlashNoMessages(volatile char *src0, int Length, volatile char *dest0);
// Selects the flash bank that makes address add readable.
void SetFlashBank(volatile unsigned short *add);

// ---- Mathematics ---------------------------------------------------------------------------------------

#define PI       3.14159265358979323846264
#define PI_F     3.1415926535f
#define TWO_PI_F (2.0f * 3.1415926535f)
#define PI_2F    (3.1415926535f * 0.5f)            // Pi/2
#define TWO_PI   (2.0 * 3.14159265358979323846264)

// Angles are in radians.

double sqrt(double x);
double exp(double x);
double log(double x);
double log10(double x);
double pow(double x, double y);
double sin(double x);
double cos(double x);
double tan(double x);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);

// The same in single precision.

float sqrtf(float x);
float expf(float x);
float logf(float x);
float log10f(float x);
float powf(float x, float y);
float sinf(float x);
float cosf(float x);
float tanf(float x);
float asinf(float x);
float acosf(float x);
float atanf(float x);
float atan2f(float y, float x);

// Absolute values: the firmware has no fabs.

double fast_fabs(double y);
float fast_fabsf(float y);

#endif // KMotionDef_h
