#ifndef _STDDEF_H
#define _STDDEF_H
#ifndef NULL
#define NULL  0
#endif
typedef unsigned int size_t;
typedef int ptrdiff_t;
typedef int wchar_t;
typedef double max_align_t;
#define offsetof(type, member) __builtin_offsetof(type, member)
#endif
