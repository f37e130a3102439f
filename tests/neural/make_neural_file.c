/* make_neural_file OUT [mosaic|light]: writes the worked example, or a set of random numbers, for
 * tests of programs: with the names and the size of the gallery's material, or with a texture of
 * 64 x 64 colors in HLG. */
#include "neural/made_file.h"
#include "neural/worked_example.h"

#include <stdio.h>
#include <string.h>

static SluiceResult write_light(const char *path)
{
    static const struct made_shape shape = {
        3, 64, 64, 4, 4, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3};
    struct made_parts parts;
    make_parts(&parts, &shape, 3);
    const SluiceNeuralTexture light = {.structSize = sizeof light,
                                       .pName = "light",
                                       .channelCount = 3,
                                       .format = SLUICE_NEURAL_CHANNEL_FLOAT16,
                                       .rgbColorSpace = SLUICE_NEURAL_COLOR_HLG};
    for (uint32_t c = 0; c < 3; c++)
        parts.spaces[c] = SLUICE_NEURAL_COLOR_HLG;
    parts.info.textureCount = 1;
    parts.info.pTextures = &light;
    parts.info.pPath = path;
    SluiceResult result = sluiceWriteNeuralFile(&parts.info);
    free_made_parts(&parts);
    return result;
}

static SluiceResult write_mosaic(const char *path)
{
    static const struct made_shape shape = {
        3, 512, 512, 4, 4, 0, 0, 0, SLUICE_NEURAL_NETWORK_SCHEMA3};
    static const char *const names[] = {"albedo", "height", "roughness"};
    SluiceNeuralTexture textures[3];
    struct made_parts parts;
    make_parts(&parts, &shape, 3);
    for (uint32_t i = 0; i < 3; i++)
        textures[i] = (SluiceNeuralTexture){.structSize = sizeof textures[i],
                                            .pName = names[i],
                                            .firstChannel = i ? i + 2 : 0,
                                            .channelCount = i ? 1 : 3,
                                            .format = SLUICE_NEURAL_CHANNEL_UNORM8,
                                            .rgbColorSpace = i ? SLUICE_NEURAL_COLOR_LINEAR
                                                               : SLUICE_NEURAL_COLOR_SRGB};
    for (uint32_t c = 0; c < 5; c++)
        parts.spaces[c] = c < 3 ? SLUICE_NEURAL_COLOR_SRGB : SLUICE_NEURAL_COLOR_LINEAR;
    parts.info.textureCount = 3;
    parts.info.pTextures = textures;
    parts.info.pPath = path;
    SluiceResult result = sluiceWriteNeuralFile(&parts.info);
    free_made_parts(&parts);
    return result;
}

int main(int argc, char **argv)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    size_t size = write_worked_example(bytes);
    if (argc == 3 && strcmp(argv[2], "mosaic") == 0)
        return write_mosaic(argv[1]) != SLUICE_SUCCESS;
    if (argc == 3 && strcmp(argv[2], "light") == 0)
        return write_light(argv[1]) != SLUICE_SUCCESS;
    FILE *file = argc == 2 ? fopen(argv[1], "wb") : NULL;
    if (!file)
        return 1;
    size_t written = fwrite(bytes, 1, size, file);
    return fclose(file) != 0 || written != size;
}
