/* Sums the partial gradients of the network in a fixed order, takes a step of Adam, and makes the
 * weights that the next step uses. Workgroup = a row of weights; 64 biases; the losses. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "train_layout.glsl"

layout(local_size_x = 256) in;

layout(set = 0, binding = 0) buffer Network { float network[]; };
layout(set = 0, binding = 1) readonly buffer Partials { float partials[]; };
layout(set = 0, binding = 7) writeonly buffer Losses { float losses[]; };

shared float slices[256];

/* Valid in threads 0 to 63, for parameters first + thread below first + count. */
float sum_of_partials(uint first, uint count)
{
    uint thread = gl_LocalInvocationIndex;
    uint slice = thread >> 6, at = first + (thread & 63u);
    float sum = 0.0;
    if ((thread & 63u) < count)
        for (uint g = slice; g < push.groupCount; g += 4u)
            sum += partials[g * TRAIN_PARTIAL + at];
    slices[thread] = sum;
    barrier();
    sum = thread < 64u ? (sum + slices[thread + 64u]) + (slices[thread + 128u] + slices[thread + 192u])
                       : 0.0;
    barrier();
    return sum;
}

/* Kingma and Ba, "Adam" (2015). */
float updated(uint at, float gradient)
{
    float value = network[TRAIN_MASTER + at];
    if (!has_flag(TRAIN_UPDATE))
        return value;
    float m = mix(gradient, network[TRAIN_FIRST_MOMENT + at], push.decay1);
    float v = mix(gradient * gradient, network[TRAIN_SECOND_MOMENT + at], push.decay2);
    value -= push.networkRate * m / (sqrt(v) + 1e-8);
    network[TRAIN_FIRST_MOMENT + at] = m;
    network[TRAIN_SECOND_MOMENT + at] = v;
    network[TRAIN_MASTER + at] = value;
    return value;
}

float row_maximum(float value)
{
    uint thread = gl_LocalInvocationIndex;
    slices[thread] = value;
    barrier();
    for (uint half_count = 32u; half_count > 0u; half_count /= 2u) {
        if (thread < half_count)
            slices[thread] = max(slices[thread], slices[thread + half_count]);
        barrier();
    }
    return slices[0];
}

void train_row(uint row)
{
    uint inputs = row < 64u ? 48u : row < 112u ? 64u : row < 144u ? 48u : 32u;
    uint outputs = row < 64u ? 64u : row < 112u ? 48u : row < 144u ? 32u : 16u;
    uint first_row = row < 64u ? 0u : row < 112u ? 64u : row < 144u ? 112u : 144u;
    uint weights = row < 64u    ? TRAIN_WEIGHTS0
                   : row < 112u ? TRAIN_WEIGHTS1
                   : row < 144u ? TRAIN_WEIGHTS2
                                : TRAIN_WEIGHTS3;
    uint output_row = row - first_row, input_row = gl_LocalInvocationIndex;
    uint first = weights + output_row * inputs;
    float gradient = has_flag(TRAIN_UPDATE) ? sum_of_partials(first, inputs) : 0.0;
    float value = input_row < inputs ? updated(first + input_row, gradient) : 0.0;
    if ((push.nextFlags & TRAIN_QUANTIZE_NETWORK) != 0u) {
        float unit = max(row_maximum(abs(value)), 1e-20) / 127.0;
        if ((push.nextFlags & TRAIN_FP8) != 0u && row < 144u)
            value = round_to_e4m3(vec4(value)).x;
        else
            value = roundEven(value / unit) * unit;
    }
    if (input_row < inputs) {
        network[TRAIN_EFFECTIVE + first + input_row] = value;
        network[TRAIN_TRANSPOSED + weights + input_row * outputs + output_row] = value;
    }
}

void main()
{
    uint group = gl_WorkGroupID.x, thread = gl_LocalInvocationIndex;
    if (group < TRAIN_ROWS) {
        train_row(group);
    } else if (group < TRAIN_ROWS + 3u) {
        uint first = (group - TRAIN_ROWS) * 64u, count = min(TRAIN_ROWS - first, 64u);
        float gradient = has_flag(TRAIN_UPDATE) ? sum_of_partials(TRAIN_BIASES + first, count) : 0.0;
        if (thread < count)
            network[TRAIN_EFFECTIVE + TRAIN_BIASES + first + thread] =
                updated(TRAIN_BIASES + first + thread, gradient);
    } else if (has_flag(TRAIN_UPDATE)) {
        float sum = sum_of_partials(TRAIN_PARAMETERS, TRAIN_OUTPUTS);
        if (thread < TRAIN_OUTPUTS)
            losses[push.lossSlot * TRAIN_OUTPUTS + thread] = sum;
    }
}
