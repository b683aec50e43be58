// Text and memory: what the firmware lacks of <string.h>.

//@ strcpy
char *strcpy(char *to, const char *from)
{
    char *at = to;
    while ((*at++ = *from++) != 0) ;
    return to;
}

//@ strncpy
char *strncpy(char *to, const char *from, unsigned count)
{
    char *at = to;
    while (count > 0 && *from) {
        *at++ = *from++;
        count--;
    }
    while (count-- > 0) {
        *at++ = 0;
    }
    return to;
}

//@ strcat
char *strcat(char *to, const char *from)
{
    char *at = to;
    while (*at) {
        at++;
    }
    while ((*at++ = *from++) != 0) ;
    return to;
}

//@ strncat
char *strncat(char *to, const char *from, unsigned count)
{
    char *at = to;
    while (*at) {
        at++;
    }
    while (count-- > 0 && *from) {
        *at++ = *from++;
    }
    *at = 0;
    return to;
}

//@ strcmp
int strcmp(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *(const unsigned char *)a - *(const unsigned char *)b;
}

//@ strncmp
int strncmp(const char *a, const char *b, unsigned count)
{
    while (count > 0 && *a && *a == *b) {
        a++;
        b++;
        count--;
    }
    return count > 0 ? *(const unsigned char *)a - *(const unsigned char *)b : 0;
}

//@ strcoll
int strcmp(const char *a, const char *b);

int strcoll(const char *a, const char *b)
{
    return strcmp(a, b);
}

//@ strchr
char *strchr(const char *text, int wanted)
{
    while (*text != (char)wanted) {
        if (*text++ == 0) {
            return 0;
        }
    }
    return (char *)text;
}

//@ strrchr
char *strrchr(const char *text, int wanted)
{
    const char *found = 0;
    do {
        if (*text == (char)wanted) {
            found = text;
        }
    } while (*text++);
    return (char *)found;
}

//@ strspn
unsigned strspn(const char *text, const char *set)
{
    const char *at = text;
    for (;; at++) {
        const char *member = set;
        while (*member && *member != *at) {
            member++;
        }
        if (*member == 0) {
            return at - text;
        }
    }
}

//@ strcspn
unsigned strcspn(const char *text, const char *set)
{
    const char *at = text;
    for (; *at; at++) {
        const char *member = set;
        while (*member && *member != *at) {
            member++;
        }
        if (*member) {
            break;
        }
    }
    return at - text;
}

//@ strpbrk
unsigned strcspn(const char *text, const char *set);

char *strpbrk(const char *text, const char *set)
{
    text += strcspn(text, set);
    return *text ? (char *)text : 0;
}

//@ strtok
unsigned strspn(const char *text, const char *set);
unsigned strcspn(const char *text, const char *set);

char *strtok(char *text, const char *separators)
{
    static char *rest;
    if (text == 0) {
        text = rest;
    }
    if (text == 0) {
        return 0;
    }
    text += strspn(text, separators);
    if (*text == 0) {
        rest = 0;
        return 0;
    }
    rest = text + strcspn(text, separators);
    if (*rest) {
        *rest++ = 0;
    } else {
        rest = 0;
    }
    return text;
}

//@ strdup
void *malloc(unsigned size);
unsigned strlen(const char *text);
void *memcpy(void *to, const void *from, unsigned count);

char *strdup(const char *text)
{
    unsigned size = strlen(text) + 1;
    char *copy = malloc(size);
    return copy ? memcpy(copy, text, size) : 0;
}

//@ stpcpy
char *stpcpy(char *to, const char *from)
{
    while ((*to = *from++) != 0) {
        to++;
    }
    return to;
}

//@ strerror
char *strerror(int number)
{
    static char text[] = "error";
    (void)number;
    return text;
}

//@ memmove
void *memmove(void *to, const void *from, unsigned count)
{
    char *target = to;
    const char *source = from;
    if (target < source) {
        while (count-- > 0) {
            *target++ = *source++;
        }
    } else {
        while (count-- > 0) {
            target[count] = source[count];
        }
    }
    return to;
}

//@ mempcpy
void *memcpy(void *to, const void *from, unsigned count);

void *mempcpy(void *to, const void *from, unsigned count)
{
    return (char *)memcpy(to, from, count) + count;
}

//@ memcmp
int memcmp(const void *a, const void *b, unsigned count)
{
    const unsigned char *left = a, *right = b;
    while (count-- > 0) {
        int difference = *left++ - *right++;
        if (difference != 0) {
            return difference;
        }
    }
    return 0;
}

//@ memchr
void *memchr(const void *memory, int wanted, unsigned count)
{
    const unsigned char *at = memory;
    while (count-- > 0) {
        if (*at == (unsigned char)wanted) {
            return (void *)at;
        }
        at++;
    }
    return 0;
}
