#include "gltf_accessor.h"

#include <stdlib.h>
#include <string.h>

static const cJSON *member(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

/* Fields that are checked already. */
static uint64_t whole(const cJSON *object, const char *name, uint64_t otherwise)
{
    const cJSON *item = member(object, name);
    return cJSON_IsNumber(item) ? (uint64_t)item->valuedouble : otherwise;
}

static uint32_t size_of(uint64_t type)
{
    return type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
}

static uint64_t read_word(const uint8_t *at, uint32_t size)
{
    uint64_t value = 0;
    for (uint32_t i = 0; i < size; i++)
        value |= (uint64_t)at[i] << (8 * i);
    return value;
}

static double read_component(const uint8_t *at, uint64_t type, bool normalized)
{
    const uint64_t bits = read_word(at, size_of(type));
    double value, most;
    float number;
    switch (type) {
    case 5120:
        value = (double)(int8_t)(uint8_t)bits;
        most = 127;
        break;
    case 5121:
        value = (double)bits;
        most = 255;
        break;
    case 5122:
        value = (double)(int16_t)(uint16_t)bits;
        most = 32767;
        break;
    case 5123:
        value = (double)bits;
        most = 65535;
        break;
    case 5125:
        value = (double)bits;
        most = 4294967295.0;
        break;
    default: memcpy(&number, &(uint32_t){(uint32_t)bits}, sizeof number); return (double)number;
    }
    if (!normalized)
        return value;
    return value / most < -1 ? -1 : value / most;
}

static void read_element(const uint8_t *at, const struct gltf_accessor *a, double *numbers)
{
    for (uint32_t c = 0; c < a->components; c++)
        numbers[c] = read_component(at + (size_t)c * size_of(a->component_type), a->component_type,
                                    a->normalized);
}

static void read_sparse(const struct gltf_file *file, const cJSON *sparse,
                        const struct gltf_accessor *a, double *numbers)
{
    const cJSON *indices = member(sparse, "indices"), *values = member(sparse, "values");
    const uint64_t count = whole(sparse, "count", 0), type = whole(indices, "componentType", 5121);
    const uint8_t *index = gltf_view_bytes(file, (uint32_t)whole(indices, "bufferView", 0)).bytes +
                           whole(indices, "byteOffset", 0);
    const uint8_t *value = gltf_view_bytes(file, (uint32_t)whole(values, "bufferView", 0)).bytes +
                           whole(values, "byteOffset", 0);
    for (uint64_t i = 0; i < count; i++)
        read_element(value + i * a->element, a,
                     numbers + read_word(index + i * size_of(type), size_of(type)) * a->components);
}

double *gltf_read_numbers(const struct gltf_file *file, uint32_t index,
                          const struct gltf_accessor *a)
{
    if (a->count > SIZE_MAX / 16 / sizeof(double))
        return NULL;
    double *numbers = calloc((size_t)a->count * a->components, sizeof *numbers);
    if (numbers && a->view != GLTF_NONE) {
        const uint8_t *bytes = gltf_view_bytes(file, a->view).bytes + a->offset;
        for (uint64_t i = 0; i < a->count; i++)
            read_element(bytes + i * a->stride, a, numbers + i * a->components);
    }
    if (numbers && a->sparse)
        read_sparse(file, member(file->lists[GLTF_ACCESSORS].items[index], "sparse"), a, numbers);
    return numbers;
}
