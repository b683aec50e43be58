// What the firmware lacks of <stdio.h> for text on the console and in memory; its `printf` and `vsnprintf` do the rest.

//@ putchar
int printf(const char *format, ...);

int putchar(int c)
{
    printf("%c", c);
    return (unsigned char)c;
}

//@ puts
int printf(const char *format, ...);

int puts(const char *text) { return printf("%s\n", text); }

//@ snprintf
int vsnprintf(char *to, unsigned size, const char *format, char *values);

int snprintf(char *to, unsigned size, const char *format, ...)
{
    __builtin_va_list values;
    int length;
    __builtin_va_start(values, format);
    length = vsnprintf(to, size, format, values);
    __builtin_va_end(values);
    return length;
}

//@ vsprintf
int vsnprintf(char *to, unsigned size, const char *format, char *values);

int vsprintf(char *to, const char *format, char *values) { return vsnprintf(to, 0x7fffffff, format, values); }

//@ vprintf
// A line of the console has fewer than 128 characters.
int printf(const char *format, ...);
int vsnprintf(char *to, unsigned size, const char *format, char *values);

int vprintf(const char *format, char *values)
{
    char text[256];
    vsnprintf(text, 256, format, values);
    return printf("%s", text);
}
