#include <sluice/metrics.h>

/** Every eighth of the map. */
static const uint8_t samples[9][3] = {
    {0, 0, 4},      {28, 16, 68},   {79, 18, 123},   {129, 37, 129},  {181, 54, 122},
    {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191},
};

static void color_of(float value, uint8_t color[4])
{
    double at = value > 0 ? (value < 1 ? 8 * (double)value : 8) : 0;
    int index = at < 7 ? (int)at : 7;
    double share = at - index;
    for (int i = 0; i < 3; i++)
        color[i] = (uint8_t)(samples[index][i] * (1 - share) + samples[index + 1][i] * share + 0.5);
    color[3] = 255;
}

SluiceResult sluiceColorMagma(const float *pValues, size_t count, uint8_t *pColors)
{
    if (count > 0 && (!pValues || !pColors))
        return SLUICE_ERROR_NULL_POINTER;
    for (size_t i = 0; i < count; i++)
        color_of(pValues[i], pColors + 4 * i);
    return SLUICE_SUCCESS;
}
