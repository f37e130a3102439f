#include "neural/worked_example.h"

#include "base/little_endian.h"

#include <stdio.h>
#include <string.h>

static const char TEXT[] =
    "{\"schemaVersion\":3,\"width\":4,\"height\":4,\"numChannels\":2,\"numColorMips\":1,"
    "\"latentShape\":{\"numFeatures\":4},\"mlpVersions\":[{\"layers\":["
    "{\"inputChannels\":48,\"outputChannels\":4,\"weightView\":0,\"scaleView\":1,\"biasView\":2,"
    "\"weightType\":\"Int8\",\"scaleType\":\"Float32\",\"biasType\":\"Int32\"},"
    "{\"inputChannels\":4,\"outputChannels\":4,\"weightView\":3,\"scaleView\":4,\"biasView\":5,"
    "\"weightType\":\"Int8\",\"scaleType\":\"Float32\",\"biasType\":\"Int32\"},"
    "{\"inputChannels\":4,\"outputChannels\":4,\"weightView\":6,\"scaleView\":7,\"biasView\":8,"
    "\"weightType\":\"Int8\",\"scaleType\":\"Float32\",\"biasType\":\"Int32\"},"
    "{\"inputChannels\":4,\"outputChannels\":16,\"weightView\":9,\"scaleView\":10,\"biasView\":11,"
    "\"weightType\":\"Int8\",\"scaleType\":\"Float32\",\"biasType\":\"Int32\"}],"
    "\"activation\":\"HGELUClamp\",\"weightLayout\":\"RowMajor\"}],"
    "\"textures\":[{\"name\":\"two\",\"firstChannel\":0,\"numChannels\":2}],"
    "\"channels\":[{},{\"colorSpace\":\"sRGB\"}],"
    "\"latents\":[{\"width\":2,\"height\":2,\"layerViews\":[12]},"
    "{\"width\":1,\"height\":1,\"layerViews\":[13]}],"
    "\"colorMips\":[{\"width\":4,\"height\":4,\"latentMip\":0,\"positionLod\":-0.5,"
    "\"positionScale\":0.25}],\"views\":[";

struct layer {
    uint32_t inputs, outputs;
    int8_t weights[4][48];
    float scale[4]; /* unused outputs have scale 1 */
    int32_t bias[4];
};

static const struct layer LAYERS[4] = {
    {48,
     4,
     {{[0] = 100}, {[2] = 50, [16] = 20}, {[32] = -30, [44] = 10}, {[37] = 64}},
     {1.0f / 4096, 1.0f / 1024, 1.0f / 1024, 1.0f / 2048},
     {6000, -1000, 0, 0}},
    {4,
     4,
     {{60, 20, -10, 5}, {-20, 70, 10, 0}, {5, 5, 80, -40}, {30, -30, 30, -30}},
     {1.0f / 8192, 1.0f / 8192, 1.0f / 8192, 1.0f / 8192},
     {9000, 6500, 5000, 200}},
    {4,
     4,
     {{90, 0, 10, 0}, {0, 90, 0, 10}, {10, 0, 90, 0}, {0, 10, 0, 90}},
     {1.0f / 8000, 1.0f / 8000, 1.0f / 8000, 1.0f / 8000},
     {11300, 11300, 11300, 11300}},
    {4,
     16,
     {{40, 30, 20, 10}, {-10, 20, -30, 40}},
     {1.0f / 16384, 1.0f / 16384, 1, 1},
     {11300, 2260}},
};

struct writer {
    char text[WORKED_EXAMPLE_MAX_SIZE];
    uint8_t data[WORKED_EXAMPLE_MAX_SIZE];
    size_t text_size, data_size;
    int view_count;
};

static void put_view(struct writer *w, const void *bytes, size_t size)
{
    int written = snprintf(w->text + w->text_size, sizeof w->text - w->text_size,
                           "%s{\"offset\":%zu,\"storedSize\":%zu}", w->view_count ? "," : "",
                           w->data_size, size);
    w->text_size += (size_t)written;
    memcpy(w->data + w->data_size, bytes, size);
    w->data_size += (size + 3) / 4 * 4;
    w->view_count++;
}

/* Writes a layer. Rows after the fourth are 0. */
static void put_layer(struct writer *w, const struct layer *layer)
{
    uint8_t weights[16 * 48] = {0}, numbers[2][64] = {{0}};
    for (uint32_t o = 0; o < layer->outputs; o++) {
        float scale = o < 4 ? layer->scale[o] : 1;
        uint32_t bits;
        memcpy(&bits, &scale, 4);
        slc_put_u32(numbers[0] + 4 * o, bits);
        slc_put_u32(numbers[1] + 4 * o, o < 4 ? (uint32_t)layer->bias[o] : 0);
        for (uint32_t i = 0; i < layer->inputs && o < 4; i++)
            weights[o * layer->inputs + i] = (uint8_t)layer->weights[o][i];
    }
    put_view(w, weights, (size_t)layer->outputs * layer->inputs);
    put_view(w, numbers[0], 4 * layer->outputs);
    put_view(w, numbers[1], 4 * layer->outputs);
}

size_t write_worked_example(uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE])
{
    static const uint8_t FINE[] = {0x0F, 0x38, 0xF5, 0x00, 0x00, 0xFF, 0x5A, 0x55},
                         COARSE[] = {0x88, 0x88};
    struct writer w = {.text_size = sizeof TEXT - 1};
    memcpy(w.text, TEXT, sizeof TEXT);
    for (int i = 0; i < 4; i++)
        put_layer(&w, &LAYERS[i]);
    put_view(&w, FINE, sizeof FINE);
    put_view(&w, COARSE, sizeof COARSE);
    memcpy(w.text + w.text_size, "]}", 3);
    w.text_size += 3;
    size_t data_offset = (40 + w.text_size + 3) / 4 * 4;
    memset(bytes, 0, data_offset);
    memcpy(bytes, "NTEX", 4);
    slc_put_u32(bytes + 4, 0x100);
    slc_put_u64(bytes + 8, 40);
    slc_put_u64(bytes + 16, w.text_size);
    slc_put_u64(bytes + 24, data_offset);
    slc_put_u64(bytes + 32, w.data_size);
    memcpy(bytes + 40, w.text, w.text_size);
    memcpy(bytes + data_offset, w.data, w.data_size);
    return data_offset + w.data_size;
}
