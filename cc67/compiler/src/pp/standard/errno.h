#ifndef _ERRNO_H
#define _ERRNO_H
extern int errno;
#define EINVAL 22
#define EDOM 33
#define ERANGE 34
#define EILSEQ 84
#endif
