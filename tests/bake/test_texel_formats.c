/*
 * UNORM16, SNORM, packed and integer formats. Expected levels are computed here in double, from the
 * definitions in Vulkan's specification.
 */
#include "bake/baked.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef HAVE_CONTAINER
#include "container/container_files.h"

#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif

enum numbers { UNORM, SNORM, A2B10G10R10, B10G11R11, E5B9G9R9 };

struct kind {
    SluiceFormat format;
    enum numbers numbers;
    uint32_t channels, size; /* bytes of a channel, of UNORM and SNORM */
};

static const struct kind kinds[] = {
    {SLUICE_FORMAT_R16_UNORM, UNORM, 1, 2},
    {SLUICE_FORMAT_R16G16_UNORM, UNORM, 2, 2},
    {SLUICE_FORMAT_R16G16B16A16_UNORM, UNORM, 4, 2},
    {SLUICE_FORMAT_R8_SNORM, SNORM, 1, 1},
    {SLUICE_FORMAT_R8G8_SNORM, SNORM, 2, 1},
    {SLUICE_FORMAT_R8G8B8A8_SNORM, SNORM, 4, 1},
    {SLUICE_FORMAT_R16_SNORM, SNORM, 1, 2},
    {SLUICE_FORMAT_R16G16_SNORM, SNORM, 2, 2},
    {SLUICE_FORMAT_R16G16B16A16_SNORM, SNORM, 4, 2},
    {SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32, A2B10G10R10, 4, 0},
    {SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32, B10G11R11, 3, 0},
    {SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32, E5B9G9R9, 3, 0},
};
#define KIND_COUNT (sizeof kinds / sizeof kinds[0])

static const uint32_t sizes[][2] = {{64, 64}, {37, 21}, {7, 1}, {1, 9}, {1, 1}, {300, 131}};
#define SIZE_COUNT (sizeof sizes / sizeof sizes[0])

static uint32_t next_random(uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    return *random >> 8;
}

static uint32_t texel_size(const struct kind *kind)
{
    return kind->size ? kind->size * kind->channels : 4;
}

/* Five bits of exponent, `bits` of mantissa. */
static double decode_float(uint32_t code, int bits)
{
    uint32_t exponent = code >> bits, mantissa = code & ((1u << bits) - 1);
    return exponent ? ldexp(1 + ldexp(mantissa, -bits), (int)exponent - 15)
                    : ldexp(mantissa, -bits - 14);
}

static void decode_word(enum numbers numbers, uint32_t word, double rgba[4])
{
    for (uint32_t c = 0; c < 3; c++)
        if (numbers == A2B10G10R10)
            rgba[c] = (word >> (10 * c) & 1023) / 1023.0;
        else if (numbers == B10G11R11)
            rgba[c] = decode_float(word >> (11 * c) & (c < 2 ? 2047 : 1023), c < 2 ? 6 : 5);
        else
            rgba[c] = ldexp(word >> (9 * c) & 511, (int)(word >> 27) - 24);
    rgba[3] = (word >> 30) / 3.0;
}

static void decode(const struct kind *kind, const uint8_t *texel, double rgba[4])
{
    if (kind->size == 0) {
        uint32_t word;
        memcpy(&word, texel, 4);
        decode_word(kind->numbers, word, rgba);
    }
    for (uint32_t c = 0; c < kind->channels && kind->size; c++, texel += kind->size) {
        int32_t code = kind->size == 1 ? texel[0] : texel[0] | texel[1] << 8;
        int32_t span = kind->size == 1 ? 256 : 65536;
        if (kind->numbers == UNORM)
            rgba[c] = code / (span - 1.0);
        else
            rgba[c] = fmax(-1, (code < span / 2 ? code : code - span) / (span / 2 - 1.0));
    }
}

/* Largest distance of a value from the nearest code of the format. */
static double half_step(const struct kind *kind, const double rgba[4], uint32_t c)
{
    switch (kind->numbers) {
    case UNORM: return 0.5 / 65535;
    case SNORM: return 0.5 / (kind->size == 1 ? 127 : 32767);
    case A2B10G10R10: return 0.5 / (c < 3 ? 1023 : 3);
    case B10G11R11: return fmax(rgba[c] * (c < 2 ? 0x1p-7 : 0x1p-6), 0x1p-20);
    default: return fmax(fmax(fmax(rgba[0], rgba[1]), rgba[2]) * 0x1p-9, 0x1p-25);
    }
}

/* Random texels without infinities. */
static uint8_t *random_texels(const struct kind *kind, uint32_t count, uint32_t seed)
{
    uint32_t size = texel_size(kind);
    uint8_t *texels = malloc((size_t)count * size);
    for (uint32_t i = 0; i < count * size; i++)
        texels[i] = (uint8_t)next_random(&seed);
    for (uint32_t i = 0; i < count && kind->numbers == B10G11R11; i++) {
        uint32_t word;
        memcpy(&word, texels + 4 * (size_t)i, 4);
        word &= ~(1u << 10 | 1u << 21 | 1u << 31); /* the highest bits of the exponents */
        memcpy(texels + 4 * (size_t)i, &word, 4);
    }
    return texels;
}

/* RGBA of one level. */
struct level {
    uint32_t width, height;
    double *rgba;
};

static uint32_t half(uint32_t size)
{
    return size > 1 ? size / 2 : 1;
}

/* The part of texel `k` that texel `i` of the level below covers, of its own size. */
static double share(uint32_t size, uint32_t i, uint32_t k)
{
    double scale = (double)size / half(size), first = i * scale, end = (i + 1) * scale;
    return fmax(0, fmin(end, k + 1.0) - fmax(first, k)) / scale;
}

static struct level next_level(const struct level *above)
{
    struct level level = {half(above->width), half(above->height), NULL};
    level.rgba = calloc(4 * (size_t)level.width * level.height, sizeof(double));
    for (uint32_t y = 0; y < level.height; y++)
        for (uint32_t x = 0; x < level.width; x++)
            for (uint32_t ky = 2 * y; ky < above->height && ky < 2 * y + 3; ky++)
                for (uint32_t kx = 2 * x; kx < above->width && kx < 2 * x + 3; kx++)
                    for (uint32_t c = 0; c < 4; c++)
                        level.rgba[4 * (y * level.width + x) + c] +=
                            share(above->width, x, kx) * share(above->height, y, ky) *
                            above->rgba[4 * (ky * above->width + kx) + c];
    return level;
}

static struct level first_level(const struct kind *kind, const uint8_t *texels, uint32_t width,
                                uint32_t height)
{
    struct level level = {width, height, NULL};
    level.rgba = calloc(4 * (size_t)width * height, sizeof(double));
    for (uint32_t i = 0; i < width * height; i++)
        decode(kind, texels + (size_t)i * texel_size(kind), level.rgba + 4 * (size_t)i);
    return level;
}

/* The vector that a normal map stores for a mean of vectors. */
static void point(const struct kind *kind, double rgba[4])
{
    double length = sqrt(rgba[0] * rgba[0] + rgba[1] * rgba[1] + rgba[2] * rgba[2]);
    for (uint32_t c = 0; c < 3; c++) {
        rgba[c] /= length;
        rgba[c] = kind->numbers == SNORM ? rgba[c] : 0.5 * rgba[c] + 0.5;
    }
}

/* One level of the store against `level`, in which vectors have any length. */
static void check_level(const char *path, uint32_t l, const struct kind *kind,
                        const struct level *level, bool normals)
{
    size_t size;
    uint8_t *bytes = read_bytes(path, l, &size);
    assert_int_equal(size, (size_t)level->width * level->height * texel_size(kind));
    for (uint32_t i = 0; i < level->width * level->height; i++) {
        double got[4], expected[4];
        memcpy(expected, level->rgba + 4 * (size_t)i, sizeof expected);
        if (normals)
            point(kind, expected);
        decode(kind, bytes + (size_t)i * texel_size(kind), got);
        for (uint32_t c = 0; c < kind->channels; c++) {
            double allowed = 1.02 * half_step(kind, expected, c) + fabs(expected[c]) * 1e-6;
            if (!(fabs(got[c] - expected[c]) <= allowed))
                fail_msg("%s, level %u of %u x %u texels, texel %u channel %u is %g, not %g",
                         sluiceGetFormatName(kind->format), l, level->width, level->height, i, c,
                         got[c], expected[c]);
        }
    }
    free(bytes);
}

struct fixture {
    struct bake_folder folder;
    char in[256], out[256], other[256];
};

static void fixture_init(struct fixture *f)
{
    bake_folder_init(&f->folder);
    bake_folder_file(&f->folder, "in", f->in);
    bake_folder_file(&f->folder, "out.store", f->out);
    bake_folder_file(&f->folder, "other.store", f->other);
}

static SluiceStoreInfo store_info(const char *path)
{
    SluiceStoreImageSourceCreateInfo create = {.structSize = sizeof create, .pPath = path};
    SluiceImageSource *source;
    SluiceStoreInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceCreateStoreImageSource(&create, &source));
    CHECK_OK(sluiceGetStoreInfo(source, &info));
    info.pSourceName = NULL; /* goes with the source */
    sluiceDestroyImageSource(source);
    return info;
}

static void check_level_zero(const char *path, const void *texels)
{
    size_t size;
    void *bytes = read_bytes(path, 0, &size);
    assert_memory_equal(bytes, texels, size);
    free(bytes);
}

static void check_means(const struct kind *kind, uint32_t width, uint32_t height)
{
    struct fixture f;
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    uint8_t *texels = random_texels(kind, width * height, width);
    fixture_init(&f);
    plain_source_init(&source, kind->format, width, height, texels);
    bake_source(&source.base, f.out, &settings);
    SluiceStoreInfo info = store_info(f.out);
    assert_int_equal(info.layout.format, kind->format);
    if (kind->numbers == SNORM)
        assert_int_equal(info.meaning, SLUICE_STORE_MEANING_DATA);
    check_level_zero(f.out, texels);
    struct level level = first_level(kind, texels, width, height);
    for (uint32_t l = 1; l < info.layout.mipLevelCount; l++) {
        struct level below = next_level(&level);
        free(level.rgba);
        level = below;
        check_level(f.out, l, kind, &level, false);
    }
    free(level.rgba);
    free(texels);
    bake_folder_finish(&f.folder);
}

static void levels_are_means_in_every_format(void **state)
{
    (void)state;
    for (size_t k = 0; k < KIND_COUNT; k++)
        for (size_t s = 0; s < SIZE_COUNT; s++)
            check_means(&kinds[k], sizes[s][0], sizes[s][1]);
}

static void encode(const struct kind *kind, const double vector[3], uint8_t *texel)
{
    uint32_t word = 0;
    for (uint32_t c = 0; c < kind->channels; c++) {
        double value = c < 3 ? vector[c] : 1, encoded = 0.5 * value + 0.5;
        if (kind->size == 0)
            word |= (uint32_t)lrint(encoded * (c < 3 ? 1023 : 3)) << (10 * c);
        int code = kind->numbers == SNORM ? (int)lrint(value * (kind->size == 1 ? 127 : 32767))
                                          : (int)lrint(encoded * 65535);
        for (uint32_t b = 0; b < kind->size; b++)
            texel[kind->size * c + b] = (uint8_t)(code >> (8 * b));
    }
    if (kind->size == 0)
        memcpy(texel, &word, 4);
}

/* Vectors that point up, so that no means are short. */
static uint8_t *random_normals(const struct kind *kind, uint32_t count, uint32_t seed)
{
    uint8_t *texels = malloc((size_t)count * texel_size(kind));
    for (uint32_t i = 0; i < count; i++) {
        double angle = next_random(&seed) * 0x1p-24 * 6.283;
        double z = 0.1 + 0.9 * next_random(&seed) * 0x1p-24, r = sqrt(1 - z * z);
        const double vector[3] = {r * cos(angle), r * sin(angle), z};
        encode(kind, vector, texels + (size_t)i * texel_size(kind));
    }
    return texels;
}

/* Vectors of length 1 of two channels, of any length of four. */
static void decode_vectors(const struct kind *kind, struct level *level)
{
    for (uint32_t i = 0; i < level->width * level->height; i++) {
        double *v = level->rgba + 4 * (size_t)i;
        for (uint32_t c = 0; c < 3 && kind->numbers != SNORM; c++)
            v[c] = 2 * v[c] - 1;
        if (kind->channels == 2)
            v[2] = sqrt(fmax(0, 1 - v[0] * v[0] - v[1] * v[1]));
    }
}

static void normals_are_vectors_of_length_one_in_every_level(void **state)
{
    (void)state;
    for (size_t k = 0; k < KIND_COUNT; k++) {
        const struct kind *kind = &kinds[k];
        struct fixture f;
        struct plain_source source;
        SluiceBakeSettings settings = {.structSize = sizeof settings, .normalMap = true};
        if (kind->numbers > A2B10G10R10 || kind->channels == 1 ||
            kind->format == SLUICE_FORMAT_R16G16_UNORM) /* becomes RGBA */
            continue;
        uint8_t *texels = random_normals(kind, 130 * 97, 7);
        fixture_init(&f);
        plain_source_init(&source, kind->format, 130, 97, texels);
        bake_source(&source.base, f.out, &settings);
        assert_int_equal(store_info(f.out).layout.format, kind->format);
        assert_int_equal(store_info(f.out).meaning, SLUICE_STORE_MEANING_NORMAL);
        check_level_zero(f.out, texels);
        struct level level = first_level(kind, texels, 130, 97);
        decode_vectors(kind, &level);
        for (uint32_t l = 1; l < 8; l++) {
            struct level below = next_level(&level);
            free(level.rgba);
            level = below;
            check_level(f.out, l, kind, &level, true);
        }
        free(level.rgba);
        free(texels);
        bake_folder_finish(&f.folder);
    }
}

static void signed_normals_are_encoded_in_unsigned_formats(void **state)
{
    (void)state;
    static const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM,
                                           SLUICE_FORMAT_R16G16B16A16_UNORM,
                                           SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32};
    static const uint8_t snorm[4] = {(uint8_t)-127, 0, 0, 127};
    static const float floats[4] = {-1, 0, 0, 1};
    for (size_t i = 0; i < 2 * (sizeof formats / sizeof formats[0]); i++) {
        struct fixture f;
        struct plain_source source;
        uint32_t width, height;
        SluiceBakeSettings settings = {
            .structSize = sizeof settings, .normalMap = true, .format = formats[i / 2]};
        fixture_init(&f);
        if (i % 2)
            plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_SNORM, 1, 1, snorm);
        else
            plain_source_init(&source, SLUICE_FORMAT_R32G32B32A32_SFLOAT, 1, 1, floats);
        bake_source(&source.base, f.out, &settings);
        float *level = read_level(f.out, 0, &width, &height);
        const double expected[4] = {0, 0.5, 0.5, 1};
        for (uint32_t c = 0; c < 4; c++)
            assert_true(fabs((double)level[c] - expected[c]) < 0.51 / 255);
        free(level);
        bake_folder_finish(&f.folder);
    }
}

static void unsigned_normals_are_decoded_in_signed_formats(void **state)
{
    (void)state;
    static const uint16_t texel[4] = {0, 32768, 65535, 65535};
    struct fixture f;
    struct plain_source source;
    uint32_t width, height;
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .normalMap = true,
                                   .format = SLUICE_FORMAT_R16G16B16A16_SNORM};
    fixture_init(&f);
    plain_source_init(&source, SLUICE_FORMAT_R16G16B16A16_UNORM, 1, 1, texel);
    bake_source(&source.base, f.out, &settings);
    float *level = read_level(f.out, 0, &width, &height);
    const double expected[4] = {-sqrt(0.5), 0, sqrt(0.5), 1};
    for (uint32_t c = 0; c < 4; c++)
        assert_true(fabs((double)level[c] - expected[c]) < 1.1 / 32767);
    free(level);
    bake_folder_finish(&f.folder);
}

static void the_least_signed_number_is_kept_and_counts_as_minus_one(void **state)
{
    (void)state;
    static const uint8_t texels[4] = {0x80, 0x80, 0x80, 0x80};
    struct fixture f;
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    size_t size;
    fixture_init(&f);
    plain_source_init(&source, SLUICE_FORMAT_R8_SNORM, 2, 2, texels);
    bake_source(&source.base, f.out, &settings);
    check_level_zero(f.out, texels);
    uint8_t *bytes = read_bytes(f.out, 1, &size);
    assert_int_equal(bytes[0], 0x81);
    free(bytes);
    settings.format = SLUICE_FORMAT_R8_UNORM; /* has no sign */
    bake_source(&source.base, f.out, &settings);
    check_level_zero(f.out, (const uint8_t[4]){0});
    bake_folder_finish(&f.folder);
}

static void infinities_of_packed_floats_become_numbers(void **state)
{
    (void)state;
    const uint32_t infinite = 0x1Fu << 6 | (0x1Fu << 6 | 1) << 11 | 0x1Fu << 27; /* +, NaN, + */
    struct fixture f;
    struct plain_source source;
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    size_t size;
    fixture_init(&f);
    plain_source_init(&source, SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32, 1, 1, &infinite);
    bake_source(&source.base, f.out, &settings);
    uint32_t *word = read_bytes(f.out, 0, &size);
    assert_int_equal(*word, ((0x1Fu << 6) - 1) | ((0x1Fu << 5) - 1) << 22);
    free(word);
    bake_folder_finish(&f.folder);
}

/* Texel of a level 0 of `size` texels that texel `i` of `level` repeats, along one axis. */
static uint32_t picked(uint32_t size, uint32_t level, uint32_t i)
{
    for (; level > 0; level--) {
        uint32_t above = size >> (level - 1), right = 0;
        for (uint32_t k = above; k > 0; k /= 2)
            right = !right; /* with even sizes, every second step takes the right texel */
        i = above > 1 ? 2 * i + (above % 2 == 1 || right == 0) : 0;
    }
    return i;
}

/* Level `level` must be picked from the level `from`, which has `width` x `height` texels. */
static void check_picked(const char *path, uint32_t level, const uint8_t *from, uint32_t width,
                         uint32_t height, uint32_t size, uint32_t depth)
{
    size_t all;
    uint8_t *bytes = read_bytes(path, level, &all);
    uint32_t w = width >> depth ? width >> depth : 1, h = height >> depth ? height >> depth : 1;
    assert_int_equal(all, (size_t)w * h * size);
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++) {
            size_t at = (size_t)picked(height, depth, y) * width + picked(width, depth, x);
            assert_memory_equal(bytes + ((size_t)y * w + x) * size, from + at * size, size);
        }
    free(bytes);
}

static void levels_of_integers_are_picked(void **state)
{
    (void)state;
    for (SluiceFormat format = SLUICE_FORMAT_R8_UINT; format <= SLUICE_FORMAT_R32G32B32A32_SINT;
         format++)
        for (size_t s = 0; s < SIZE_COUNT; s++) {
            struct fixture f;
            struct plain_source source;
            uint32_t width = sizes[s][0], height = sizes[s][1], random = (uint32_t)s;
            uint32_t size = sluiceGetFormatTexelSize(format);
            SluiceBakeSettings settings = {.structSize = sizeof settings};
            uint8_t *texels = malloc((size_t)width * height * size);
            for (size_t i = 0; i < (size_t)width * height * size; i++)
                texels[i] = (uint8_t)next_random(&random);
            fixture_init(&f);
            plain_source_init(&source, format, width, height, texels);
            bake_source(&source.base, f.out, &settings);
            SluiceStoreInfo info = store_info(f.out);
            assert_int_equal(info.layout.format, format);
            assert_int_equal(info.meaning, SLUICE_STORE_MEANING_DATA);
            for (uint32_t l = 0; l < info.layout.mipLevelCount; l++)
                check_picked(f.out, l, texels, width, height, size, l);
            free(texels);
            bake_folder_finish(&f.folder);
        }
}

static void keep_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)severity;
    snprintf(user, 512, "%s", message);
}

static void check_refused(SluiceFormat from, SluiceFormat to, const char *first, const char *second)
{
    static const uint8_t texel[16];
    struct fixture f;
    struct plain_source source;
    char message[512] = "";
    SluiceBaker *baker;
    SluiceBakerCreateInfo create = {.structSize = sizeof create,
                                    .threadCount = 1,
                                    .log = {.pfnLog = keep_message, .pUserData = message}};
    SluiceBakeSettings settings = {.structSize = sizeof settings, .format = to};
    fixture_init(&f);
    plain_source_init(&source, from, 1, 1, texel);
    CHECK_OK(sluiceCreateBaker(&create, &baker));
    SluiceBakeInfo bake = {.structSize = sizeof bake,
                           .source = &source.base,
                           .pOutputPath = f.out,
                           .pSettings = &settings};
    CHECK_RESULT(sluiceBakeFile(baker, &bake, NULL), SLUICE_ERROR_UNSUPPORTED);
    if (!strstr(message, f.out) || !strstr(message, first) || !strstr(message, second))
        fail_msg("%s", message);
    sluiceDestroyBaker(baker);
    bake_folder_finish(&f.folder);
}

static void integers_become_nothing_else_and_nothing_else_becomes_integers(void **state)
{
    (void)state;
    check_refused(SLUICE_FORMAT_R8G8_UINT, SLUICE_FORMAT_R8_UINT, "format is R8_UINT",
                  "must be R8G8_UINT");
    check_refused(SLUICE_FORMAT_R32_SINT, SLUICE_FORMAT_BC4_UNORM_BLOCK,
                  "format is BC4_UNORM_BLOCK", "must be R32_SINT");
    check_refused(SLUICE_FORMAT_R8_UNORM, SLUICE_FORMAT_R8_UINT, "format is R8_UINT", "integer");
    check_refused(SLUICE_FORMAT_R16_SNORM, SLUICE_FORMAT_R16_SINT, "format is R16_SINT", "integer");
}

#ifdef HAVE_CONTAINER
static SluiceImageSource *open_file(const char *path, bool is_dds)
{
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds, .pPath = path};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2, .pPath = path};
    SluiceImageSource *source;
    CHECK_OK(is_dds ? sluiceCreateDdsImageSource(&dds, &source)
                    : sluiceCreateKtx2ImageSource(&ktx2, &source));
    return source;
}

static void write_file(const char *path, const struct picture *picture, bool is_dds)
{
    struct file_bytes bytes = is_dds ? make_dds(picture) : make_ktx2(picture, 0);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes.bytes, 1, bytes.size, file), bytes.size);
    assert_int_equal(fclose(file), 0);
    free(bytes.bytes);
}

static uint8_t *level_of_file(const struct picture *picture, uint32_t level)
{
    uint32_t width = picture->width >> level, height = picture->height >> level;
    size_t size = (size_t)(width ? width : 1) * (height ? height : 1) * picture->format->block_size;
    uint8_t *bytes = malloc(size);
    for (size_t i = 0; i < size; i++)
        bytes[i] = picture_byte(0, level, i);
    return bytes;
}
#endif

/* All levels are made from the file's level 0, also if it has others. */
static void files_become_what_their_level_zero_becomes(void **state)
{
    (void)state;
#ifndef HAVE_CONTAINER
    SKIP_TEST("this build reads no DDS files");
#else
    for (size_t i = 0; i < 6 * KIND_COUNT; i++) {
        const struct kind *kind = &kinds[i / 6];
        struct picture picture = {.format = format_names_of(kind->format),
                                  .width = 70,
                                  .height = 45,
                                  .level_count = (uint32_t)(i % 6 / 2)};
        struct fixture f;
        SluiceBakeSettings settings = {.structSize = sizeof settings};
        if (kind->numbers != SNORM)
            settings.alpha = SLUICE_BAKE_ALPHA_PREMULTIPLIED; /* the default of sources */
        fixture_init(&f);
        write_file(f.in, &picture, i % 2);
        bake_picture_file(f.in, f.out, &settings);
        SluiceImageSource *source = open_file(f.in, i % 2);
        bake_source(source, f.other, &settings);
        sluiceDestroyImageSource(source);
        assert_int_equal(store_info(f.out).layout.format, kind->format);
        for (uint32_t l = 0; l < 7; l++) {
            size_t size, other_size;
            uint8_t *bytes = read_bytes(f.out, l, &size);
            uint8_t *other = read_bytes(f.other, l, &other_size);
            assert_int_equal(size, other_size);
            assert_memory_equal(bytes, other, size);
            free(other);
            free(bytes);
        }
        bake_folder_finish(&f.folder);
    }
#endif
}

static void integer_levels_of_files_are_kept_and_those_missing_are_picked(void **state)
{
    (void)state;
#ifndef HAVE_CONTAINER
    SKIP_TEST("this build reads no DDS files");
#else
    static const SluiceFormat formats[] = {SLUICE_FORMAT_R8_UINT, SLUICE_FORMAT_R16G16_SINT,
                                           SLUICE_FORMAT_R32G32B32A32_UINT};
    for (uint32_t i = 0; i < 24; i++) {
        struct picture picture = {.format = format_names_of(formats[i / 8]),
                                  .width = 300,
                                  .height = 77,
                                  .level_count = i % 8 / 2};
        struct fixture f;
        SluiceBakeSettings settings = {.structSize = sizeof settings};
        uint32_t last = picture_level_count(&picture) - 1;
        fixture_init(&f);
        write_file(f.in, &picture, i % 2);
        bake_picture_file(f.in, f.out, &settings);
        for (uint32_t l = 0; l < 9; l++) {
            uint32_t from = l < last ? l : last;
            uint8_t *bytes = level_of_file(&picture, from);
            check_picked(f.out, l, bytes, 300 >> from, 77 >> from ? 77 >> from : 1,
                         picture.format->block_size, l - from);
            free(bytes);
        }
        bake_folder_finish(&f.folder);
    }
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_are_means_in_every_format),
        cmocka_unit_test(normals_are_vectors_of_length_one_in_every_level),
        cmocka_unit_test(signed_normals_are_encoded_in_unsigned_formats),
        cmocka_unit_test(unsigned_normals_are_decoded_in_signed_formats),
        cmocka_unit_test(the_least_signed_number_is_kept_and_counts_as_minus_one),
        cmocka_unit_test(infinities_of_packed_floats_become_numbers),
        cmocka_unit_test(levels_of_integers_are_picked),
        cmocka_unit_test(integers_become_nothing_else_and_nothing_else_becomes_integers),
        cmocka_unit_test(files_become_what_their_level_zero_becomes),
        cmocka_unit_test(integer_levels_of_files_are_kept_and_those_missing_are_picked),
    };
    return RUN_TESTS(tests);
}
