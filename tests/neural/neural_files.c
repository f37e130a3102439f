#include "neural/neural_files.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>

SluiceResult open_neural_bytes(const uint8_t *bytes, size_t size,
                               const SluiceAllocationCallbacks *cb, SluiceNeuralSet **set)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = bytes, .size = size};
    SluiceNeuralSetCreateInfo info = {
        .structSize = sizeof info, .pAllocator = cb, .pInput = &input};
    return sluiceOpenNeuralSet(&info, set);
}

bool find_neural_sample(const char *name, char *path, size_t size)
{
    const char *data = getenv("SLUICE_TEST_DATA"), *root = getenv("SLUICE_SOURCE_ROOT");
    if (data)
        snprintf(path, size, "%s/ntc/%s", data, name);
    else
        snprintf(path, size, "%s/../shared/data/ntc/%s", root ? root : ".", name);
    FILE *file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file != NULL;
}

int need_neural_samples(const char *const *names)
{
    char path[512];
    for (; *names; names++)
        if (!find_neural_sample(*names, path, sizeof path)) {
            printf("1..0 # SKIP %s is not there; SLUICE_TEST_DATA says where the data folder is\n",
                   path);
            return 77;
        }
    return 0;
}

SluiceNeuralSet *open_neural_sample(const char *path)
{
    SluiceNeuralSetCreateInfo info = {.structSize = sizeof info, .pPath = path};
    SluiceNeuralSet *set = NULL;
    CHECK_OK(sluiceOpenNeuralSet(&info, &set));
    return set;
}

uint8_t *read_neural_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    uint8_t *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}
