#include "neural/network.h"

#include "base/alloc.h"
#include "base/little_endian.h"
#include "image/half.h"
#include "neural/view_reader.h"

#include <math.h>
#include <string.h>

/* Limit of scales. The product of any sum and a smaller scale is a finite float. */
#define MAX_SCALE 0x1p63f

enum { LAST = SLUICE_NEURAL_LAYERS - 1, MAX_LAYER_SIZE = 96 * 64 };

/* Tells whether a layer has FP8 weights, or HALF weights made from FP8. */
static bool is_fp8(SluiceNeuralWeightKind kind, uint32_t layer)
{
    return kind != SLUICE_NEURAL_WEIGHTS_INT8 && layer < LAST;
}

struct slc_neural_blob slc_neural_blob_of(const struct slc_neural_shape *shape,
                                          SluiceNeuralWeightKind kind)
{
    struct slc_neural_blob blob = {{0}, {0}, {0}, 0};
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        blob.weights[i] = blob.size;
        blob.size += shape->outputs[i] * shape->inputs[i] *
                     (kind == SLUICE_NEURAL_WEIGHTS_HALF && i < LAST ? 2 : 1);
    }
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++)
        if (is_fp8(kind, i)) {
            blob.biases[i] = blob.size;
            blob.size += 2 * shape->outputs[i];
        } else {
            blob.scales[i] = blob.size;
            blob.size += 4 * shape->outputs[i];
        }
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++)
        if (!is_fp8(kind, i)) {
            blob.biases[i] = blob.size;
            blob.size += 4 * shape->outputs[i];
        }
    return blob;
}

/* Returns the type of a layer's weights; version 0.5 stores the type per network. */
static uint32_t weight_type(const struct slc_neural_mlp *mlp, uint32_t layer)
{
    uint32_t type = mlp->layers[layer].weight_type;
    return type ? type : mlp->weight_type;
}

static uint32_t number_type(const struct slc_neural_mlp *mlp, uint32_t layer, uint32_t own)
{
    uint32_t both = mlp->layers[layer].scale_bias_type;
    return own ? own : both ? both : mlp->scale_bias_type;
}

static bool is_of_kind(const struct slc_neural_mlp *mlp, SluiceNeuralWeightKind kind)
{
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++)
        if (weight_type(mlp, i) != (is_fp8(kind, i) ? SLC_NEURAL_E4M3 : SLC_NEURAL_INT8))
            return false;
    return mlp->layer_count == SLUICE_NEURAL_LAYERS;
}

static SluiceResult refuse_layer(const SluiceNeuralSet *set, uint32_t layer, const char *what)
{
    return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA, "layer %u of a network %s", layer,
                          what);
}

/* Checks the sizes of layers. Hidden layers of schema 3 may be smaller than the network's. */
static SluiceResult check_layers(const SluiceNeuralSet *set, const struct slc_neural_mlp *mlp)
{
    const struct slc_neural_shape *shape = &set->shape;
    if (!mlp->is_activation_known || !mlp->is_row_major)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has a network whose activation or weightLayout is missing");
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        const struct slc_neural_layer *layer = &mlp->layers[i];
        uint32_t inputs = i ? mlp->layers[i - 1].outputs : shape->inputs[0];
        bool is_fixed = i == LAST || set->info.schema == 1;
        if (layer->inputs != inputs)
            return refuse_layer(set, i, "has another number of inputs than its layer before");
        if (layer->outputs == 0 || layer->outputs > shape->outputs[i] ||
            (is_fixed && layer->outputs != shape->outputs[i]))
            return refuse_layer(set, i, "has a wrong number of outputs");
    }
    return SLUICE_SUCCESS;
}

/* Bytes of one layer during the read. */
struct layer_bytes {
    uint8_t weights[MAX_LAYER_SIZE];
    uint8_t scales[4 * 64];
    uint8_t biases[4 * 64];
};

static SluiceResult read_numbers(const SluiceNeuralSet *set, const struct slc_neural_document *d,
                                 uint32_t index, uint64_t size, void *bytes)
{
    struct slc_neural_view view;
    SluiceResult result = slc_neural_find_view(set, d, index, size, &view);
    return result == SLUICE_SUCCESS ? slc_neural_read_view(set, &view, bytes) : result;
}

static float float_at(const uint8_t *bytes)
{
    return slc_float_from_bits(slc_get_u32(bytes));
}

/* Converts float biases of version 0.5 to multiples of the scale. */
static bool convert_biases(struct layer_bytes *bytes, uint32_t outputs, uint32_t inputs)
{
    for (uint32_t o = 0; o < outputs; o++) {
        float scale = float_at(bytes->scales + 4 * o), bias = float_at(bytes->biases + 4 * o);
        if (scale == 0) {
            scale = 0x1p-16f;
            slc_put_u32(bytes->scales + 4 * o, slc_float_bits(scale));
            memset(bytes->weights + (size_t)o * inputs, 0, inputs);
        }
        double rounded = rint((double)bias / (double)scale);
        if (!(fabs(rounded) <= INT32_MAX))
            return false;
        slc_put_u32(bytes->biases + 4 * o, (uint32_t)(int32_t)rounded);
    }
    return true;
}

static SluiceResult read_int8_layer(const SluiceNeuralSet *set, const struct slc_neural_document *d,
                                    const struct slc_neural_mlp *mlp, uint32_t i,
                                    struct layer_bytes *bytes)
{
    const struct slc_neural_layer *layer = &mlp->layers[i];
    uint32_t size = 4 * layer->outputs;
    uint32_t bias_type = number_type(mlp, i, layer->bias_type);
    SluiceResult result = SLUICE_SUCCESS;
    if (layer->scale_view == SLC_NONE)
        for (uint32_t o = 0; o < layer->outputs; o++)
            slc_put_u32(bytes->scales + 4 * o, slc_float_bits(1.0f));
    else if (number_type(mlp, i, layer->scale_type) != SLC_NEURAL_FLOAT)
        return refuse_layer(set, i, "has scales that are not Float32");
    else
        result = read_numbers(set, d, layer->scale_view, size, bytes->scales);
    if (bias_type != SLC_NEURAL_INT32 && bias_type != SLC_NEURAL_FLOAT)
        return refuse_layer(set, i, "has biases that are not Int32");
    if (result == SLUICE_SUCCESS)
        result = read_numbers(set, d, layer->bias_view, size, bytes->biases);
    if (result == SLUICE_SUCCESS && bias_type == SLC_NEURAL_FLOAT &&
        !convert_biases(bytes, layer->outputs, layer->inputs))
        return refuse_layer(set, i, "has a bias beyond 2^31 of its scales");
    return result;
}

static SluiceResult read_layer(const SluiceNeuralSet *set, const struct slc_neural_document *d,
                               const struct slc_neural_mlp *mlp, uint32_t i, bool is_half,
                               struct layer_bytes *bytes)
{
    const struct slc_neural_layer *layer = &mlp->layers[i];
    SluiceResult result = read_numbers(set, d, layer->weight_view,
                                       (uint64_t)layer->inputs * layer->outputs, bytes->weights);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!is_half)
        return read_int8_layer(set, d, mlp, i, bytes);
    if (number_type(mlp, i, layer->bias_type) != SLC_NEURAL_HALF || layer->scale_view != SLC_NONE)
        return refuse_layer(set, i, "has scales, or biases that are not Float16");
    return read_numbers(set, d, layer->bias_view, 2 * (uint64_t)layer->outputs, bytes->biases);
}

/* Places a layer in the blob. Padding has weights and biases 0 and scales 1, without effect. */
static void place_layer(const SluiceNeuralSet *set, const struct slc_neural_blob *blob,
                        const struct slc_neural_layer *layer, uint32_t i, bool is_half,
                        const struct layer_bytes *bytes, uint8_t *out)
{
    uint32_t inputs = set->shape.inputs[i];
    for (uint32_t o = 0; o < layer->outputs; o++)
        memcpy(out + blob->weights[i] + (size_t)o * inputs,
               bytes->weights + (size_t)o * layer->inputs, layer->inputs);
    memcpy(out + blob->biases[i], bytes->biases, (is_half ? 2 : 4) * (size_t)layer->outputs);
    for (uint32_t o = 0; !is_half && o < set->shape.outputs[i]; o++)
        slc_put_u32(out + blob->scales[i] + 4 * (size_t)o,
                    o < layer->outputs ? slc_get_u32(bytes->scales + 4 * (size_t)o)
                                       : slc_float_bits(1.0f));
}

bool slc_neural_blob_is_sound(const struct slc_neural_shape *shape, SluiceNeuralWeightKind kind,
                              const uint8_t *blob)
{
    struct slc_neural_blob at = slc_neural_blob_of(shape, kind);
    bool is_sound = true;
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        uint32_t weights = shape->inputs[i] * shape->outputs[i];
        for (uint32_t w = 0; is_fp8(kind, i) && w < weights; w++)
            is_sound &= (blob[at.weights[i] + w] & 0x7F) != 0x7F; /* NaN */
        for (uint32_t o = 0; o < shape->outputs[i]; o++)
            if (is_fp8(kind, i))
                is_sound &= (blob[at.biases[i] + 2 * o + 1] & 0x7C) != 0x7C; /* infinite, NaN */
            else
                is_sound &= fabsf(float_at(blob + at.scales[i] + 4 * o)) <= MAX_SCALE;
    }
    return is_sound;
}

static SluiceResult read_network(SluiceNeuralSet *set, const struct slc_neural_document *d,
                                 const struct slc_neural_mlp *mlp, SluiceNeuralWeightKind kind)
{
    struct slc_neural_blob blob = slc_neural_blob_of(&set->shape, kind);
    SluiceResult result = check_layers(set, mlp);
    if (result != SLUICE_SUCCESS)
        return result;
    uint8_t *out = slc_calloc(&set->allocator, blob.size, 1);
    struct layer_bytes *bytes = slc_alloc(&set->allocator, 1, sizeof *bytes);
    set->weights[kind] = out;
    if (!out || !bytes)
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS && result == SLUICE_SUCCESS; i++) {
        result = read_layer(set, d, mlp, i, is_fp8(kind, i), bytes);
        if (result == SLUICE_SUCCESS)
            place_layer(set, &blob, &mlp->layers[i], i, is_fp8(kind, i), bytes, out);
    }
    slc_free(&set->allocator, bytes, 1, sizeof *bytes);
    if (result == SLUICE_SUCCESS && !slc_neural_blob_is_sound(&set->shape, kind, out))
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has a scale, bias or weight that is no number or beyond 2^63");
    return result;
}

static const struct slc_neural_mlp *find_network(const struct slc_neural_document *d,
                                                 SluiceNeuralWeightKind kind)
{
    if (is_of_kind(&d->mlp, kind))
        return &d->mlp;
    for (uint32_t i = 0; i < d->mlp_count; i++)
        if (is_of_kind(&d->mlps[i], kind))
            return &d->mlps[i];
    return NULL;
}

static bool choose_shape(SluiceNeuralSet *set, uint32_t inputs)
{
    SluiceNeuralSetInfo *info = &set->info;
    info->network = SLUICE_NEURAL_NETWORK_SCHEMA3;
    if (info->schema == 1 && inputs >= 48 && inputs <= 96 && inputs % 16 == 0)
        info->network = (SluiceNeuralNetwork)((inputs - 48) / 16);
    set->shape = slc_neural_shape_of(info->network);
    info->inputCount = set->shape.inputs[0];
    /* features beyond those of the network have no input */
    bool fits =
        info->schema == 3 || (info->highFeatures <= (inputs - 32) / 4 && info->lowFeatures <= 16);
    return info->inputCount == inputs && fits;
}

SluiceResult slc_neural_read_networks(struct SluiceNeuralSet *set,
                                      const struct slc_neural_document *d)
{
    const struct slc_neural_mlp *networks[] = {find_network(d, SLUICE_NEURAL_WEIGHTS_INT8),
                                               find_network(d, SLUICE_NEURAL_WEIGHTS_FP8)};
    SluiceResult result = SLUICE_SUCCESS;
    set->info.hasInt8 = networks[0] != NULL;
    set->info.hasFp8 = networks[1] != NULL;
    if (!networks[0] && !networks[1])
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has no network with INT8 or FP8 weights");
    uint32_t inputs = networks[networks[0] ? 0 : 1]->layers[0].inputs;
    if (!choose_shape(set, inputs))
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "has a network with %u inputs, which its latents do not fit", inputs);
    for (int kind = 0; kind < 2 && result == SLUICE_SUCCESS; kind++)
        if (networks[kind])
            result = read_network(set, d, networks[kind], (SluiceNeuralWeightKind)kind);
    return result;
}
