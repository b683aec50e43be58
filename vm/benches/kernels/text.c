// Memory and strings: words are copied, compared, turned around and counted in a table.

int printf(const char *format, ...);

static char pool[4096], line[256];
static int counts[1024];

static int length_of(const char *s)
{
    const char *p = s;

    while (*p)
        p++;
    return p - s;
}

static void copy(char *to, const char *from)
{
    while ((*to++ = *from++))
        ;
}

static void reverse(char *s)
{
    char *end = s + length_of(s) - 1;

    while (s < end) {
        char c = *s;

        *s++ = *end;
        *end-- = c;
    }
}

static int same(const char *a, const char *b)
{
    while (*a && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

static unsigned hash(const char *s)
{
    unsigned h = 2166136261u;

    for (; *s; s++)
        h = (h ^ (unsigned char)*s) * 16777619u;
    return h;
}

int main(void)
{
    int i, round, matches = 0;
    unsigned sum = 0;

    for (i = 0; i < 4095; i++)
        pool[i] = i % 61 == 60 ? 0 : 'a' + (i * i + i / 61) % 26;
    for (round = 0; round < 1000000; round++) {
        char *word = pool + round % 64 * 61;

        word += length_of(word) > 0 ? 0 : 1;
        copy(line, word);
        reverse(line);
        sum = 31 * sum + ++counts[hash(line) % 1024];
        matches += same(line, word);
        reverse(line);
        matches += same(line, word);
    }
    printf("%d matches, sum %u\n", matches, sum);
    return 0;
}
