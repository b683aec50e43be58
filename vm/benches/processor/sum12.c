// The same of n times twelve elements (c67x.md 7.2).
int sum12(int *a, int n)
{
    int s = 0, t = 0, *b = a + 1;
    do {
        s += a[0];
        t += b[0];
        s += a[2];
        t += b[2];
        s += a[4];
        t += b[4];
        s += a[6];
        t += b[6];
        s += a[8];
        t += b[8];
        s += a[10];
        t += b[10];
        a += 12;
        b += 12;
    } while (--n);
    return s + t;
}
