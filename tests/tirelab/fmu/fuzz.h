/* What the two fuzzers draw from: numbers, good and odd, from a seed. A program includes it once. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static unsigned long long seed;
static unsigned draw(unsigned below)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (unsigned)(seed >> 33) % below;
}

static double real(void)
{
    static const double odd[] = {0, -0.0, NAN, INFINITY, -INFINITY, 1e308, -1e308, 5e-324, 22, 1e-300, -1, 1};
    unsigned long long bits;
    double any;
    switch (draw(8)) {
    case 0:
        return odd[draw(sizeof odd / sizeof *odd)];
    case 1:
        bits = ((unsigned long long)draw(1u << 31) << 33) ^ ((unsigned long long)draw(1u << 31) << 11) ^ draw(2048);
        memcpy(&any, &bits, sizeof any);
        return any;
    default:
        return 1e-5 * (double)draw(3000);
    }
}

/* A value reference: most often an input, now and then a parameter, seldom any number at all. */
static unsigned reference(void) { return draw(20) ? draw(4) ? draw(2) : draw(120) : draw(1u << 31) * 2; }

/* Change the bytes of a state, most often in one place or a double; half of the times the sum at their end is right. */
static void change(unsigned char *bytes, size_t size)
{
    unsigned long long sum = 14695981039346656037u;
    const double value = real();
    if (draw(2))
        bytes[draw((unsigned)size)] ^= (unsigned char)draw(256);
    else
        memcpy(bytes + 8 * draw((unsigned)(size / 8)), &value, sizeof value);
    for (size_t i = 0; i < size - sizeof sum; i++)
        sum = (sum ^ bytes[i]) * 1099511628211u;
    if (draw(2))
        memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
}

static long calls, taken, refused, messages;
static void counted(int status)
{
    calls++;
    taken += status == 0;
    refused += (status & 3) != 0;
}
