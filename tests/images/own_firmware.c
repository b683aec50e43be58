// A firmware: it starts, answers its timer, prints, echoes what the PC sends, and moves a step generator.

#define REGISTER(number) (*(volatile unsigned char *)(0x91000002 + 4 * (number)))
#define TIMER(offset) (*(volatile unsigned *)(0x42000000 + (offset)))

// Registers of the FPGA.
enum { STATUS = 0x04, DATA = 0x05, RATE = 0x3C };

volatile int ticks, next = 10;

// Assembled code that goes back at once.
#define SERVICE ((void (*)(int))0x80002000)

// What answers the timer; assembled code calls it.
void (*volatile handler)(void);

static void send(const char *text)
{
    while (*text) REGISTER(STATUS) = *text++;
}

// A number of two digits; the division of the firmware that programs call is not here.
static void send_number(int number)
{
    int tens;

    for (tens = 0; number >= 10; tens++) number -= 10;
    REGISTER(STATUS) = '0' + tens;
    REGISTER(STATUS) = '0' + number;
}

// Steps a second are rate * 200 MHz / 12 / 2^23.
static void step(int generator, int rate)
{
    REGISTER(RATE) = rate;
    REGISTER(RATE + 1) = rate >> 8;
    REGISTER(RATE + 2) = rate >> 16;
    REGISTER(RATE + 3) = 0x80 | generator;
}

// The interrupt of the timer.
void tick(void)
{
    TIMER(0x88) = 1;
    ticks++;
    SERVICE(ticks);
    if (ticks == 5) step(2, 1 << 20);
    if (ticks == next)
    {
        next += 10;
        send("\x1btick ");
        send_number(ticks);
        send("\r\n");
    }
}

main()
{
    handler = tick;
    // Two halves of 90 us in units of 20 ns, again and again, with an interrupt at the match.
    TIMER(0x18) = 1;
    TIMER(0x38) = 1;
    TIMER(0x0C) = 1;
    TIMER(0x50) = 4500;
    TIMER(0x54) = 4500;
    TIMER(0x80) = 1;
    TIMER(0x00) = 3;
    for (;;)
        if (REGISTER(STATUS)) REGISTER(STATUS) = REGISTER(DATA);
}
