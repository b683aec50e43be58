// CRC-16 bit by bit.
int crc16(unsigned char *p, int n)
{
    unsigned c = 0xFFFF;
    int i, k;

    for (i = 0; i < n; i++) {
        c ^= p[i];
        for (k = 0; k < 8; k++)
            c = c & 1 ? (c >> 1) ^ 0xA001 : c >> 1;
    }
    return c;
}
