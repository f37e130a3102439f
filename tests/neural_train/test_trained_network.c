/* The networks that are exported against the parameters that they are made of. */
#include "neural_train/naive_texel.h"
#include "neural_train/trained_network.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

static float parameters[TRAIN_PARAMETERS];

/* Random, with biases, at the sizes of a trained network. */
static void fill_parameters(uint32_t seed)
{
    slc_network_init(parameters, seed);
    for (uint32_t i = 0; i < TRAIN_ROWS; i++)
        parameters[TRAIN_BIASES + i] = slc_train_unit_float(slc_train_hash(i + 77u * seed)) - 0.5f;
}

static double gelu(double r)
{
    return fmin(r, 3.0) * fmax(fmin(r / 3.0 + 0.5, 1.0), 0.0);
}

/* Evaluates the network without rounding. */
static void evaluate(const double inputs[48], double outputs[16])
{
    static const int ins[4] = {48, 64, 48, 32}, outs[4] = {64, 48, 32, 16};
    const float *weight = parameters, *bias = parameters + TRAIN_BIASES;
    double values[64], next[64] = {0};
    memcpy(values, inputs, 48 * sizeof *inputs);
    for (int l = 0; l < 4; l++) {
        for (int o = 0; o < outs[l]; o++) {
            double sum = (double)*bias++;
            for (int i = 0; i < ins[l]; i++)
                sum += values[i] * (double)*weight++;
            next[o] = l < 3 ? gelu(sum) : sum;
        }
        memcpy(values, next, sizeof values);
    }
    memcpy(outputs, values, 16 * sizeof *outputs);
}

static void make_inputs(uint32_t number, int8_t codes[48], double values[48])
{
    for (uint32_t i = 0; i < 48; i++) {
        codes[i] = (int8_t)(slc_train_hash(number * 48 + i) >> 24);
        values[i] = codes[i] / 127.5;
    }
}

/* Relative to the spread of the outputs: root of the mean square. */
struct error {
    double squares, spread;
};

static double relative(const struct error *error)
{
    return sqrt(error->squares / error->spread);
}

static void int8_network_computes_what_was_trained(void **state)
{
    (void)state;
    struct error error = {0};
    struct slc_int8_network network;
    _Static_assert(sizeof network == 9472, "as the blob of a file");
    for (uint32_t number = 0; number < 200; number++) {
        int8_t codes[48];
        double inputs[48], wanted[16];
        float outputs[16];
        if (number % 20 == 0)
            fill_parameters(number);
        slc_network_to_int8(parameters, &network);
        make_inputs(number, codes, inputs);
        evaluate(inputs, wanted);
        naive_network(&network, codes, outputs);
        for (int i = 0; i < 16; i++) {
            error.squares += pow((double)outputs[i] - wanted[i], 2.0);
            error.spread += wanted[i] * wanted[i];
        }
    }
    assert_true(relative(&error) < 0.02); /* 0.011: weights of 8 bits, values of 1/80 */
}

static void fp8_network_computes_what_was_trained(void **state)
{
    (void)state;
    struct error error = {0};
    struct slc_fp8_network network;
    _Static_assert(sizeof network == 8608, "as the blob of a file");
    for (uint32_t number = 0; number < 40; number++) {
        int8_t codes[48];
        double inputs[48], wanted[16], outputs[16];
        if (number % 20 == 0)
            fill_parameters(number);
        slc_network_to_fp8(parameters, &network);
        make_inputs(number, codes, inputs);
        evaluate(inputs, wanted);
        naive_fp8_network(&network, inputs, outputs);
        for (int i = 0; i < 16; i++) {
            error.squares += pow(outputs[i] - wanted[i], 2.0);
            error.spread += wanted[i] * wanted[i];
        }
    }
    assert_true(relative(&error) < 0.1); /* four bits of mantissa */
}

static void rows_of_zeros_are_their_biases(void **state)
{
    (void)state;
    struct slc_int8_network network;
    const int8_t inputs[48] = {0};
    float outputs[16];
    memset(parameters, 0, sizeof parameters);
    for (uint32_t i = 0; i < 16; i++)
        parameters[TRAIN_BIAS3 + i] = (float)i / 16.0f;
    slc_network_to_int8(parameters, &network);
    naive_network(&network, inputs, outputs);
    for (uint32_t i = 0; i < 16; i++)
        assert_true(fabsf(outputs[i] - (float)i / 16.0f) < 1e-6f);
}

static void e4m3_codes_are_the_nearest(void **state)
{
    (void)state;
    for (int code = 0; code < 256; code++)
        if ((code & 127) != 127 && code != 128)
            assert_int_equal(slc_train_e4m3((float)naive_e4m3((uint8_t)code)), code);
    for (uint32_t i = 0; i < 20000; i++) {
        float unit = slc_train_unit_float(slc_train_hash(i));
        float x = ldexpf(unit - 0.5f, (int)(i % 20) - 9);
        double made = naive_e4m3(slc_train_e4m3(x)), off = fabs(made - (double)x);
        for (int code = 0; code < 127; code++)
            assert_true(off <= fabs(naive_e4m3((uint8_t)code) - fabs((double)x)) + 1e-12);
    }
    assert_int_equal(slc_train_e4m3(1e9f), 0x7E); /* 448 */
}

static void parameters_that_are_no_numbers_export_as_zero(void **state)
{
    static struct slc_int8_network network;
    (void)state;
    fill_parameters(1);
    parameters[0] = NAN;
    parameters[1] = INFINITY;
    parameters[TRAIN_BIASES] = NAN;
    slc_network_to_int8(parameters, &network);
    assert_int_equal(network.weights[0], 0);
    assert_int_equal(network.weights[1], 0);
    assert_true(isfinite(network.scales[0]) && network.scales[0] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parameters_that_are_no_numbers_export_as_zero),
        cmocka_unit_test(int8_network_computes_what_was_trained),
        cmocka_unit_test(fp8_network_computes_what_was_trained),
        cmocka_unit_test(rows_of_zeros_are_their_biases),
        cmocka_unit_test(e4m3_codes_are_the_nearest),
    };
    return RUN_TESTS(tests);
}
