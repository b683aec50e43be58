// A servo's arithmetic in singles: PID, two second-order filters, a dead band, per sample.

int printf(const char *format, ...);

static float b0 = 0.0201f, b1 = 0.0402f, b2 = 0.0201f, a1 = 1.561f, a2 = -0.6414f;
static float x1, x2, y1, y2, u1, u2, v1, v2;

static float smooth(float x)
{
    float y = b0 * x + b1 * x1 + b2 * x2 + a1 * y1 + a2 * y2, v;

    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = y;
    v = b0 * y + b1 * u1 + b2 * u2 + a1 * v1 + a2 * v2;
    u2 = u1;
    u1 = y;
    v2 = v1;
    v1 = v;
    return v;
}

int main(void)
{
    float position = 0, velocity = 0, integral = 0, last = 0, error, output;
    int sample;

    for (sample = 0; sample < 20000000; sample++) {
        float dest = sample / 8192 % 2 ? 100.0f : -100.0f;

        error = dest - position;
        if (error < 0.01f && error > -0.01f)
            error = 0;
        integral += 0.0002f * error;
        if (integral > 50.0f)
            integral = 50.0f;
        if (integral < -50.0f)
            integral = -50.0f;
        output = smooth(0.8f * error + integral + 6.0f * (error - last));
        last = error;
        velocity += 0.01f * (output - 0.5f * velocity);
        position += 0.01f * velocity;
    }
    printf("%f %f %f\n", position, velocity, integral);
    return 0;
}
