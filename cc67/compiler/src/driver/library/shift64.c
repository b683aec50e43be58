// Shifts of 64 bits by a count that is not known; it counts modulo 64.

//@ __cc67_shl64 __cc67_shr64 __cc67_shru64
typedef unsigned long long u64;

u64 __cc67_shl64(u64 a, int count)
{
    unsigned low = (unsigned)a, high = (unsigned)(a >> 32);
    count = count & 63;
    if (count >= 32) {
        high = low << count - 32;
        low = 0;
    } else if (count > 0) {
        high = high << count | low >> 32 - count;
        low = low << count;
    }
    return (u64)high << 32 | low;
}

u64 __cc67_shru64(u64 a, int count)
{
    unsigned low = (unsigned)a, high = (unsigned)(a >> 32);
    count = count & 63;
    if (count >= 32) {
        low = high >> count - 32;
        high = 0;
    } else if (count > 0) {
        low = low >> count | high << 32 - count;
        high = high >> count;
    }
    return (u64)high << 32 | low;
}

long long __cc67_shr64(long long a, int count)
{
    unsigned low = (unsigned)a;
    int high = (int)(a >> 32);
    count = count & 63;
    if (count >= 32) {
        low = high >> count - 32;
        high = high >> 31;
    } else if (count > 0) {
        low = low >> count | (unsigned)high << 32 - count;
        high = high >> count;
    }
    return (u64)(unsigned)high << 32 | low;
}
