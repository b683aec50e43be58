// cc67: run
//
// atomic.c - changing single bits of a shared word without being interrupted.
//
//   cc67 run c-programs/threads/atomic.c
//
// Between the reading and the writing of "Word |= Mask" another thread may change
// the word. AtomicSet, AtomicClear and TestAndSet cannot be interrupted.
//
// Expect F0, then F1, then 31, and a claim that succeeds once.

#include "KMotionDef.h"

#define FLAGS 45            // persist: a word of flags
#define OWNER 46            // persist: 0 = free, else the number of the owner

void Claim(int Me)
{
    int Owner = TestAndSet(&persist.UserData[OWNER], Me);

    if (Owner == 0) printf("%d: claimed\n", Me);
    else printf("%d: belongs to %d\n", Me, Owner);
}

main()
{
    int *Flags = &persist.UserData[FLAGS];

    *Flags = 0xF0;
    printf("%02X\n", *Flags);

    AtomicSet(Flags, 0x01);
    printf("%02X\n", *Flags);

    AtomicClear(Flags, ~0xC0);      // ones mark the bits that stay
    printf("%02X\n", *Flags);

    persist.UserData[OWNER] = 0;
    Claim(7);
    Claim(8);
}
