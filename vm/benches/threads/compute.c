// Computes without ever waiting.

int main(void)
{
    unsigned n = 1, x = 1;
    double sum = 0;

    for (;;) {
        x = x * 1664525u + 1013904223u;
        sum = 0.5 * sum + (x >> 16);
        n += x & 1;
    }
}
