// Digits of 3 x 5 points, for the numbers of tiles. Bit 14 is the upper left point.
const uint digits[10] = uint[](0x7b6fu, 0x2c97u, 0x73e7u, 0x73cfu, 0x5bc9u, 0x79cfu, 0x79efu, 0x7249u, 0x7befu, 0x7bcfu);

uint digitCount(uint number)
{
    return number < 10u ? 1u : number < 100u ? 2u : number < 1000u ? 3u : 4u;
}

/* Returns true if a point is dark in a number of at most 4 digits. Digits are 4 points apart. */
bool numberAt(uint number, uvec2 at)
{
    uint count = digitCount(number), place = at.x / 4u, column = at.x % 4u;
    if (place >= count || column == 3u || at.y >= 5u)
        return false;
    for (uint i = place + 1u; i < count; i++)
        number /= 10u;
    return (digits[number % 10u] >> (14u - 3u * at.y - column) & 1u) != 0u;
}
