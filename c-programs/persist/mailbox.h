// mailbox.h - where the letters between mailbox.c and mailbox_receiver.c lie.

#define BOX_FULL    60      // persist: TRUE while a letter waits
#define BOX_SUBJECT 61      // persist: what it is about, see below
#define BOX_VALUE   62      // persist: its value, a float
#define BOX_SUM     63      // persist: the receiver's answer, a float

#define SUBJECT_ADD 1
#define SUBJECT_END 2
