#include "base/text_number.h"

#include <math.h>

#define MAX_DIGITS 18

static bool is_digit(unsigned char c)
{
    return (unsigned)c - '0' < 10u;
}

/* Exact up to 22. */
static const double POWERS[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

static double scaled(uint64_t digits, int32_t exponent)
{
    double number = (double)digits;
    if (digits == 0)
        return 0;
    if (exponent >= 0 && exponent <= 22)
        return number * POWERS[exponent];
    if (exponent < 0 && exponent >= -22)
        return number / POWERS[-exponent];
    if (exponent > 400)
        return HUGE_VAL;
    if (exponent < -400)
        return 0;
    for (; exponent > 0; exponent -= exponent < 22 ? exponent : 22)
        number *= POWERS[exponent < 22 ? exponent : 22];
    for (; exponent<0; exponent += exponent> - 22 ? -exponent : 22)
        number /= POWERS[exponent > -22 ? -exponent : 22];
    return number;
}

/* The exponent behind "e"; `c` stays if there is none. */
static const unsigned char *read_exponent(const unsigned char *c, int32_t *exponent)
{
    const unsigned char *digit = c + 1;
    bool is_negative = *digit == '-';
    int32_t value = 0;
    if (*digit == '-' || *digit == '+')
        digit++;
    if (!is_digit(*digit))
        return c;
    for (; is_digit(*digit); digit++)
        value = value < 100000 ? 10 * value + (*digit - '0') : value;
    *exponent += is_negative ? -value : value;
    return digit;
}

const unsigned char *slc_read_number(const unsigned char *text, double *number)
{
    const unsigned char *c = text;
    bool is_negative = *c == '-';
    uint64_t digits = 0;
    int32_t count = 0, exponent = 0;
    bool has_digit;
    if (*c == '-' || *c == '+')
        c++;
    const unsigned char *first = c;
    for (; is_digit(*c); c++) {
        if (count < MAX_DIGITS) {
            digits = 10 * digits + (uint64_t)(*c - '0');
            count += digits > 0;
        } else {
            exponent += exponent < 100000;
        }
    }
    has_digit = c > first;
    if (*c == '.') {
        const unsigned char *fraction = ++c;
        for (; is_digit(*c); c++) {
            if (count < MAX_DIGITS) {
                digits = 10 * digits + (uint64_t)(*c - '0');
                count += digits > 0;
                exponent -= exponent > -100000;
            }
        }
        has_digit |= c > fraction;
    }
    if (!has_digit)
        return text;
    if (*c == 'e' || *c == 'E')
        c = read_exponent(c, &exponent);
    double value = scaled(digits, exponent);
    *number = is_negative ? -value : value;
    return c;
}

const unsigned char *slc_read_integer(const unsigned char *text, int32_t *number)
{
    const unsigned char *c = text;
    bool is_negative = *c == '-';
    int64_t value = 0;
    if (*c == '-' || *c == '+')
        c++;
    const unsigned char *first = c;
    for (; is_digit(*c) && value <= INT32_MAX; c++)
        value = 10 * value + (*c - '0');
    if (is_negative)
        value = -value;
    if (c == first || is_digit(*c) || value > INT32_MAX || value < INT32_MIN)
        return text;
    *number = (int32_t)value;
    return c;
}
