// A product of vectors of doubles with two sums, which do not wait for each other (c67x.md 7.3).
double dot2(double *x, double *y, int n)
{
    double s = 0, t = 0;

    n >>= 1;
    do {
        s += x[0] * y[0];
        t += x[1] * y[1];
        x += 2;
        y += 2;
    } while (--n);
    return s + t;
}
