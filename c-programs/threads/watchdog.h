// watchdog.h - what the watchdog and the job share.

#define JOB       2                 // thread
#define ROUNDS    40                // persist: rounds that the job has done
#define MOTORS_ON 1041              // virtual bit that the amplifiers depend on
