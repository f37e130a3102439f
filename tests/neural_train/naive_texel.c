#include "neural_train/naive_texel.h"

#include <math.h>
#include <string.h>

static const int input_counts[4] = {48, 64, 48, 32}, output_counts[4] = {64, 48, 32, 16};

static int code_at(const SluiceNeuralTrainedImage *image, int64_t x, int64_t y, uint32_t feature)
{
    int64_t w = image->width, h = image->height;
    x = (x + w) % w;
    y = (y + h) % h;
    size_t at = ((size_t)(feature / 4) * image->height + (size_t)y) * image->width + (size_t)x;
    return image->pTexels[at] >> (feature % 4 * 4) & 15;
}

static int8_t feature_code(const SluiceNeuralTrainedImage *image, uint32_t feature, uint32_t x,
                           uint32_t y, uint32_t width, uint32_t height)
{
    int64_t gx = (2 * (int64_t)x + 1) * image->width * 256 / (2 * (int64_t)width) - 128;
    int64_t gy = (2 * (int64_t)y + 1) * image->height * 256 / (2 * (int64_t)height) - 128;
    int64_t x0 = gx >> 8, y0 = gy >> 8, fx = gx & 255, fy = gy & 255;
    int64_t sum = (256 - fx) * (256 - fy) * code_at(image, x0, y0, feature) +
                  fx * (256 - fy) * code_at(image, x0 + 1, y0, feature) +
                  (256 - fx) * fy * code_at(image, x0, y0 + 1, feature) +
                  fx * fy * code_at(image, x0 + 1, y0 + 1, feature);
    return (int8_t)((17 * sum >> 16) - 128);
}

void naive_inputs(const SluiceNeuralTrainedSet *set, uint32_t mip, uint32_t width, uint32_t height,
                  uint32_t x, uint32_t y, int8_t inputs[48])
{
    const SluiceNeuralTrainedMip *facts = &set->mips[mip];
    memset(inputs, 0, 48);
    for (uint32_t image = 0; image < 2; image++)
        for (uint32_t f = 0; f < set->featureCount; f++)
            inputs[image * 16 + f] = feature_code(&set->latentImages[facts->latentImage + image], f,
                                                  x, y, width, height);
    float p[2] = {(float)x * facts->positionScale, (float)y * facts->positionScale};
    for (uint32_t wave = 0; wave < 3; wave++)
        for (uint32_t i = 0; i < 4; i++) {
            float t = p[i % 2] * (float)(1 << wave) + (i < 2 ? 0.0f : 0.25f);
            float e = 2.0f * (t - floorf(t)) - 1.0f;
            inputs[32 + wave * 4 + i] = (int8_t)truncf(e * 127.5f);
        }
    inputs[44] = inputs[45] = (int8_t)truncf(facts->positionLod * 127.5f);
}

static int hidden_code(float r)
{
    float t = fmaxf(fminf(r * 0.333333f + 0.5f, 1.0f), 0.0f);
    return (int)rintf(fminf(r, 3.0f) * t * 80.0f) - 113;
}

void naive_network(const void *int8, const int8_t inputs[48], float outputs[16])
{
    const int8_t *weights = int8;
    const char *scales = (const char *)int8 + 8192, *biases = scales + 640;
    int codes[64], next[64] = {0};
    for (int i = 0; i < 48; i++)
        codes[i] = inputs[i];
    for (int l = 0; l < 4; l++) {
        for (int o = 0; o < output_counts[l]; o++, scales += 4, biases += 4) {
            int32_t sum;
            float scale;
            memcpy(&sum, biases, 4);
            memcpy(&scale, scales, 4);
            for (int i = 0; i < input_counts[l]; i++)
                sum += codes[i] * *weights++;
            float r = (float)sum * scale;
            if (l == 3)
                outputs[o] = r;
            else
                next[o] = hidden_code(r);
        }
        memcpy(codes, next, sizeof codes);
    }
}

double naive_e4m3(uint8_t code)
{
    int exponent = code >> 3 & 15, mantissa = code & 7;
    double size = exponent ? ldexp(8 + mantissa, exponent - 10) : ldexp(mantissa, -9);
    return code & 128 ? -size : size;
}

/* Compares with all values. */
static double nearest_e4m3(double x)
{
    uint8_t best = 0;
    for (int code = 0; code < 127; code++) {
        double distance = fabs(naive_e4m3((uint8_t)code) - fabs(x));
        double best_distance = fabs(naive_e4m3(best) - fabs(x));
        if (distance < best_distance || (distance == best_distance && code % 2 == 0))
            best = (uint8_t)code;
    }
    return x < 0 ? -naive_e4m3(best) : naive_e4m3(best);
}

static double half_at(const char *bytes)
{
    uint16_t h;
    memcpy(&h, bytes, 2);
    int exponent = h >> 10 & 31, mantissa = h & 1023;
    double size = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return h & 0x8000 ? -size : size;
}

static double gelu(double r)
{
    return fmin(r, 3.0) * fmax(fmin(r * 0.333333 + 0.5, 1.0), 0.0);
}

void naive_fp8_network(const void *fp8, const double inputs[48], double outputs[16])
{
    const uint8_t *weights = fp8;
    const char *biases = (const char *)fp8 + 8192;
    double values[64], next[64] = {0};
    for (int i = 0; i < 48; i++)
        values[i] = nearest_e4m3(inputs[i]);
    for (int l = 0; l < 3; l++) {
        for (int o = 0; o < output_counts[l]; o++, biases += 2) {
            double sum = half_at(biases);
            for (int i = 0; i < input_counts[l]; i++)
                sum += values[i] * naive_e4m3(*weights++);
            next[o] = l == 2 ? rint(gelu(sum) * 80.0) - 113 : nearest_e4m3(gelu(sum));
        }
        memcpy(values, next, sizeof values);
    }
    for (int o = 0; o < 16; o++) {
        int32_t sum;
        float scale;
        memcpy(&scale, biases + 4 * o, 4);
        memcpy(&sum, biases + 64 + 4 * o, 4);
        for (int i = 0; i < 32; i++)
            sum += (int)values[i] * (int8_t)*weights++;
        outputs[o] = (double)((float)sum * scale);
    }
}
