#include "options.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEFAULT_MEMORY ((uint64_t)1 << 30)

struct name {
    const char *name;
    int value;
};

static const struct name formats[] = {
    {"auto", SLUICE_FORMAT_UNDEFINED},
    {"r8", SLUICE_FORMAT_R8_UNORM},
    {"rg8", SLUICE_FORMAT_R8G8_UNORM},
    {"rgba8", SLUICE_FORMAT_R8G8B8A8_UNORM},
    {"r16f", SLUICE_FORMAT_R16_SFLOAT},
    {"rg16f", SLUICE_FORMAT_R16G16_SFLOAT},
    {"rgba16f", SLUICE_FORMAT_R16G16B16A16_SFLOAT},
    {"r32f", SLUICE_FORMAT_R32_SFLOAT},
    {"rg32f", SLUICE_FORMAT_R32G32_SFLOAT},
    {"rgba32f", SLUICE_FORMAT_R32G32B32A32_SFLOAT},
    {"rgb10a2", SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32},
    {"rg11b10f", SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32},
    {"rgb9e5", SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32},
    {"bc1", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK},
    {"bc3", SLUICE_FORMAT_BC3_UNORM_BLOCK},
    {"bc4", SLUICE_FORMAT_BC4_UNORM_BLOCK},
    {"bc5", SLUICE_FORMAT_BC5_UNORM_BLOCK},
    {NULL, 0},
};
static const struct name filters[] = {
    {"box", SLUICE_BAKE_FILTER_BOX}, {"kaiser", SLUICE_BAKE_FILTER_KAISER}, {NULL, 0}};
static const struct name wraps[] = {{"clamp", SLUICE_BAKE_WRAP_CLAMP},
                                    {"repeat", SLUICE_BAKE_WRAP_REPEAT},
                                    {"mirror", SLUICE_BAKE_WRAP_MIRROR},
                                    {NULL, 0}};
static const struct name alphas[] = {{"auto", SLUICE_BAKE_ALPHA_AUTO},
                                     {"straight", SLUICE_BAKE_ALPHA_STRAIGHT},
                                     {"premultiplied", SLUICE_BAKE_ALPHA_PREMULTIPLIED},
                                     {NULL, 0}};

static bool wrong(const char *option, const char *expected, const char *value)
{
    text_say("sluice-bake: %s takes %s, not '%s'", option, expected, value);
    return false;
}

static bool parse_name(const char *option, const struct name *names, const char *value, int *out)
{
    char known[256] = "";
    for (; names->name; names++) {
        if (strcmp(names->name, value) == 0) {
            *out = names->value;
            return true;
        }
        snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", *known ? ", " : "",
                 names->name);
    }
    return wrong(option, known, value);
}

static bool parse_count(const char *value, uint64_t max, uint64_t *out, const char **rest)
{
    char *end;
    if (*value < '0' || *value > '9')
        return false;
    *out = strtoull(value, &end, 10);
    *rest = end;
    return *out <= max;
}

static bool parse_size(const char *value, uint64_t *out)
{
    const char *rest;
    uint32_t shift = 20;
    if (!parse_count(value, UINT64_C(1) << 33, out, &rest))
        return false;
    if (*rest == 'K' || *rest == 'M' || *rest == 'G')
        shift = *rest == 'K' ? 10 : *rest == 'M' ? 20 : 30, rest++;
    *out <<= shift;
    return *rest == '\0' && *out > 0;
}

/* "both" or "x,y" */
static bool parse_wrap(struct options *o, const char *option, const char *value)
{
    char x[32];
    int in_x, in_y;
    const char *comma = strchr(value, ',');
    size_t length = comma ? (size_t)(comma - value) : strlen(value);
    snprintf(x, sizeof x, "%.*s", (int)(length < 31 ? length : 31), value);
    if (!parse_name(option, wraps, x, &in_x) ||
        !parse_name(option, wraps, comma ? comma + 1 : x, &in_y))
        return false;
    o->settings.wrapX = (SluiceBakeWrap)in_x;
    o->settings.wrapY = (SluiceBakeWrap)in_y;
    return true;
}

static bool parse_compression(struct options *o, const char *option, const char *value)
{
    uint64_t level;
    const char *rest;
    o->settings.uncompressed = strcmp(value, "none") == 0;
    if (o->settings.uncompressed)
        return true;
    if (!parse_count(value, 22, &level, &rest) || *rest || level == 0)
        return wrong(option, "none or a level from 1 to 22", value);
    o->settings.compressionLevel = (uint32_t)level;
    return true;
}

static bool parse_cutout(struct options *o, const char *option, const char *value)
{
    char *end;
    o->settings.cutout = strtof(value, &end);
    if (*end || end == value || !(o->settings.cutout > 0.0f && o->settings.cutout <= 1.0f))
        return wrong(option, "an alpha above 0 and at most 1", value);
    return true;
}

static bool parse_threads(struct options *o, const char *option, const char *value)
{
    uint64_t count;
    const char *rest;
    if (!parse_count(value, 256, &count, &rest) || *rest || count == 0)
        return wrong(option, "a number from 1 to 256", value);
    o->threads = (uint32_t)count;
    return true;
}

static bool takes_value(const char *option)
{
    static const char *const options[] = {"-o",       "--format", "--filter",      "--wrap",
                                          "--alpha",  "--cutout", "--compression", "--threads",
                                          "--memory", "--output"};
    for (size_t i = 0; i < sizeof options / sizeof options[0]; i++)
        if (strcmp(option, options[i]) == 0)
            return true;
    return false;
}

static bool parse_value(struct options *o, const char *option, const char *value)
{
    SluiceBakeSettings *s = &o->settings;
    int number = 0;
    bool is_fine = false;
    if (strcmp(option, "-o") == 0 || strcmp(option, "--output") == 0)
        return (o->output = value);
    if (strcmp(option, "--wrap") == 0)
        return parse_wrap(o, option, value);
    if (strcmp(option, "--cutout") == 0)
        return parse_cutout(o, option, value);
    if (strcmp(option, "--compression") == 0)
        return parse_compression(o, option, value);
    if (strcmp(option, "--threads") == 0)
        return parse_threads(o, option, value);
    if (strcmp(option, "--memory") == 0)
        return parse_size(value, &o->memory) || wrong(option, "a size like 512M or 2G", value);
    if (strcmp(option, "--format") == 0) {
        is_fine = parse_name(option, formats, value, &number);
        s->format = (SluiceFormat)number;
    } else if (strcmp(option, "--filter") == 0) {
        is_fine = parse_name(option, filters, value, &number);
        s->filter = (SluiceBakeFilter)number;
    } else {
        is_fine = parse_name(option, alphas, value, &number);
        s->alpha = (SluiceBakeAlpha)number;
    }
    return is_fine;
}

static bool parse_flag(struct options *o, const char *option)
{
    if (strcmp(option, "--srgb") == 0)
        o->settings.transfer = SLUICE_BAKE_TRANSFER_SRGB;
    else if (strcmp(option, "--linear") == 0)
        o->settings.transfer = SLUICE_BAKE_TRANSFER_LINEAR;
    else if (strcmp(option, "--normal") == 0)
        o->settings.normalMap = true;
    else if (strcmp(option, "--keep-primaries") == 0)
        o->settings.keepPrimaries = true;
    else if (strcmp(option, "--force") == 0)
        o->force = true;
    else if (strcmp(option, "--verify") == 0)
        o->verify = true;
    else if (strcmp(option, "--json") == 0)
        o->json = true;
    else if (strcmp(option, "--help") == 0 || strcmp(option, "-h") == 0)
        o->help = true;
    else {
        text_say("sluice-bake: there is no option %s; --help says more", option);
        return false;
    }
    return true;
}

static bool is_complete(const struct options *o)
{
    const char *missing = NULL;
    if (o->input_count == 0)
        missing = o->verify ? "a file to verify is needed" : "a picture is needed";
    else if (!o->output && !o->verify)
        missing = "-o is needed: a .store file or a folder";
    else if (o->settings.normalMap && o->settings.transfer == SLUICE_BAKE_TRANSFER_SRGB)
        missing = "--normal or --srgb, not both";
    if (missing)
        text_say("sluice-bake: %s; --help says more", missing);
    return !missing;
}

bool parse_options(struct options *o, int argc, char **argv)
{
    bool only_names = false;
    *o = (struct options){.inputs = argv + 1, .memory = DEFAULT_MEMORY};
    for (int i = 1; i < argc; i++) {
        char *word = argv[i];
        if (only_names || word[0] != '-' || word[1] == '\0') {
            o->inputs[o->input_count++] = word;
        } else if (strcmp(word, "--") == 0) {
            only_names = true;
        } else if (takes_value(word)) {
            if (++i == argc || !*argv[i]) {
                text_say("sluice-bake: %s needs a value", word);
                return false;
            }
            if (!parse_value(o, word, argv[i]))
                return false;
        } else if (!parse_flag(o, word)) {
            return false;
        }
    }
    return o->help || is_complete(o);
}

void print_help(void)
{
    printf(
        "usage: sluice-bake IN... -o OUT|DIR [options]\n"
        "       sluice-bake --verify FILE|DIR... [--json]\n"
        "\n"
        "Makes tile stores of pictures: anything that libvips reads, OpenEXR, DDS, KTX2, larger\n"
        "than memory, too. IN is a picture or a folder, which is searched for pictures and keeps\n"
        "its structure under DIR. OUT is a file if IN is one picture and OUT is no folder and\n"
        "does not end in a slash.\n"
        "What was made from the same file with the same settings is left alone.\n"
        "\n"
        "  -o OUT|DIR            where to (required)\n"
        "  --format NAME         auto, r8, rg8, rgba8, r16f, rg16f, rgba16f, r32f, rg32f, "
        "rgba32f,\n"
        "                        rgb10a2, rg11b10f, rgb9e5, bc1, bc3, bc4, bc5 (auto: by "
        "channels,\n"
        "                        bit depth and meaning)\n"
        "  --srgb, --linear      what the numbers are (sRGB for integers of two channels or more,\n"
        "                        linear for one channel, floats and normal maps)\n"
        "  --normal              a normal map: levels keep vectors of length 1 (no)\n"
        "  --keep-primaries      colors of OpenEXR files as they are, not converted to Rec. 709 "
        "(no)\n"
        "  --alpha NAME          straight or premultiplied; the latter, too, if it is no coverage\n"
        "                        (straight, for OpenEXR premultiplied)\n"
        "  --cutout ALPHA        keep the share of texels with at least this alpha in all levels;\n"
        "                        reads pictures twice (no)\n"
        "  --filter NAME         box or kaiser (box)\n"
        "  --wrap X[,Y]          clamp, repeat or mirror: what kaiser sees beyond edges (clamp)\n"
        "  --compression LEVEL   zstd's, 1 to 22, or none (%u)\n"
        "  --force               bake also what is up to date (no)\n"
        "  --threads N           (one per processor)\n"
        "  --memory SIZE         for all pictures under way, like 512M or 2G (%uG)\n"
        "  --verify              read every tile of stores, of folders all, and compare checksums\n"
        "  --json                one JSON object per line and file instead of the table\n"
        "  --help                this text\n"
        "\n"
        "Exit status: 0 all is well; 1 a file could not be baked, or is damaged; the others are\n"
        "baked all the same; 2 wrong usage.\n",
        SLUICE_BAKE_DEFAULT_COMPRESSION, (unsigned)(DEFAULT_MEMORY >> 30));
}
