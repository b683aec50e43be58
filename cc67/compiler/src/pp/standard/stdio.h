#ifndef _STDIO_H
#define _STDIO_H
#include <stddef.h>
#include <stdarg.h>
#define EOF (-1)
#define BUFSIZ 128
#define FILENAME_MAX 128
typedef int FILE;
int printf(const char *format, ...);
int sprintf(char *to, const char *format, ...);
int snprintf(char *to, size_t size, const char *format, ...);
int vprintf(const char *format, va_list values);
int vsprintf(char *to, const char *format, va_list values);
int vsnprintf(char *to, size_t size, const char *format, va_list values);
int sscanf(const char *text, const char *format, ...);
int puts(const char *text);
int putchar(int character);
FILE *fopen(const char *path, const char *mode);
int fclose(FILE *file);
int fprintf(FILE *file, const char *format, ...);
int fscanf(FILE *file, const char *format, ...);
char *fgets(char *to, int size, FILE *file);
int feof(FILE *file);
#endif
