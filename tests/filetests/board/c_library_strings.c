// The string functions, as a computer's C library does them: what is printed was printed by gcc's program, too.
//@ prints: spindle on at 100!|
//@ prints: 0101234589
//@ prints: 2345676789
//@ prints: 1 -1 9
//@ prints: 1 -1 11
//@ prints: 2 -1 11
//@ prints: 4 0 11
//@ prints: 4 0 11
//@ prints: 5 -1
//@ prints:  Aa Zz 99 ~~
//@ prints: a line
//@ prints: xy 120 121
//@ prints: 12 8 axes  #
//@ prints: 4 8 axes 
int printf(const char *format, ...);
int puts(const char *text);
int putchar(int c);
int sprintf(char *to, const char *format, ...);
int snprintf(char *to, unsigned room, const char *format, ...);
void *memset(void *to, int byte, unsigned count);
void *memmove(void *to, const void *from, unsigned count);
void *memchr(const void *from, int byte, unsigned count);
char *strcpy(char *to, const char *from);
char *strcat(char *to, const char *from);
char *strncat(char *to, const char *from, unsigned count);
char *strchr(const char *text, int c);
char *strrchr(const char *text, int c);
unsigned strspn(const char *text, const char *set);
unsigned strcspn(const char *text, const char *set);
char *strpbrk(const char *text, const char *set);
int toupper(int c);
int tolower(int c);

char text[40], other[40];

// How far a pointer is from the beginning, -1 for none.
static int place(const char *found, const char *from)
{
    return found ? (int)(found - from) : -1;
}

main()
{
    int i;

    strcpy(text, "spindle");
    strcat(text, " on");
    strncat(text, " at 100 %", 7);
    strncat(text, "!", 7);
    printf("%s|\n", text);

    strcpy(text, "0123456789");
    memmove(text + 2, text, 6);
    printf("%s\n", text);
    strcpy(text, "0123456789");
    memmove(text, text + 2, 6);
    printf("%s\n", text);

    strcpy(text, "tool change");
    printf("%d %d %d\n", place(memchr(text, 'o', 11), text), place(memchr(text, 'g', 9), text),
           place(memchr(text, 'g', 10), text));
    printf("%d %d %d\n", place(strchr(text, 'o'), text), place(strchr(text, 'x'), text), place(strchr(text, 0), text));
    printf("%d %d %d\n", place(strrchr(text, 'o'), text), place(strrchr(text, 'x'), text), place(strrchr(text, 0), text));
    printf("%d %d %d\n", (int)strspn(text, "lot"), (int)strspn(text, "x"), (int)strspn(text, "tol changea"));
    printf("%d %d %d\n", (int)strcspn(text, " "), (int)strcspn(text, "t"), (int)strcspn(text, "xyz"));
    printf("%d %d\n", place(strpbrk(text, "cn"), text), place(strpbrk(text, "xyz"), text));

    for (i = 0; "aZ9~"[i]; i++)
        printf(" %c%c", toupper("aZ9~"[i]), tolower("aZ9~"[i]));
    putchar('\n');
    puts("a line");
    i = putchar('x');
    printf(" %d %d\n", i, putchar(256 + 'y'));

    memset(other, '#', 12);
    printf("%d ", snprintf(other, 8, "%d axes of %d", 8, 64));
    printf("%s %c\n", other, other[8]);
    printf("%d ", snprintf(other, 0, "none"));
    printf("%s\n", other);
}
//@ cycles: 101196
