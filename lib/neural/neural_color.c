#include <sluice/neural.h>

#include <math.h>

/* Hybrid log-gamma. */
static const double A = 0.17883277, B = 0.28466892, C = 0.55991073;

static double to_linear(double e, SluiceNeuralColorSpace space)
{
    if (space == SLUICE_NEURAL_COLOR_SRGB)
        return e <= 0.04045 ? e / 12.92 : pow((e + 0.055) / 1.055, 2.4);
    if (space == SLUICE_NEURAL_COLOR_HLG) {
        double h = fabs(e);
        return copysign(h < 0.5 ? 4 * h * h : exp((h - C) / A) + B, e);
    }
    return e;
}

static double from_linear(double l, SluiceNeuralColorSpace space)
{
    if (space == SLUICE_NEURAL_COLOR_SRGB)
        return l <= 0.0031308 ? 12.92 * l : 1.055 * pow(l, 1 / 2.4) - 0.055;
    if (space == SLUICE_NEURAL_COLOR_HLG) {
        double e = fabs(l);
        return copysign(e < 1 ? sqrt(e) / 2 : A * log(e - B) + C, l);
    }
    return l;
}

float sluiceConvertNeuralColor(float value, SluiceNeuralColorSpace from, SluiceNeuralColorSpace to)
{
    return from == to ? value : (float)from_linear(to_linear((double)value, from), to);
}
