// A product of vectors of doubles; each sum waits for the one before.
double dot(double *x, double *y, int n)
{
    double s = 0;
    int i;

    for (i = 0; i < n; i++)
        s += x[i] * y[i];
    return s;
}
