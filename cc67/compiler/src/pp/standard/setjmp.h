#ifndef _SETJMP_H
#define _SETJMP_H
typedef int jmp_buf[16];
int setjmp(jmp_buf place);
void longjmp(jmp_buf place, int value);
#endif
