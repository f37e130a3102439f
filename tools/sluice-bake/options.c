#include "options.h"

#include "../common/files.h"
#include "../common/picture_names.h"
#include "../common/shared_options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char usage[] =
    "usage: sluice-bake IN... -o OUT|DIR [options]\n"
    "       sluice-bake --cube PX NX PY NY PZ NZ -o OUT [options]\n"
    "       sluice-bake --array IN... -o OUT [options]\n"
    "       sluice-bake --neural PICTURE... -o OUT.ntc [options]\n"
    "       sluice-bake --verify FILE|DIR|URL... [--json]\n"
    "       sluice-bake IN... -o DIR --plan PLAN [options]\n"
    "       sluice-bake --shard I/N PLAN\n"
    "       sluice-bake --merge PLAN -o CATALOGUE [--shard 1/N]\n"
    "\n"
    "Makes tile stores of pictures: anything that libvips reads, OpenEXR, DDS, KTX2, larger\n"
    "than memory, too. IN is a picture or a folder, which is searched for pictures and keeps\n"
    "its structure under DIR. OUT is a file if IN is one picture and OUT is no folder and\n"
    "does not end in a slash.\n"
    "What was made from the same file with the same settings is left alone. Options end at --.\n";

static const char notes[] =
    "SLURM_CPUS_PER_TASK sets the worker threads where --threads does not.\n"
    "Exit status: 0 all is well; 1 a file could not be baked, or is damaged; the others are\n"
    "baked all the same; 2 wrong usage.\n";

/* Names in the order of the enumerations, for --format, --quality, --filter and --alpha. */
static const char format_names[] =
    "auto|r8|rg8|rgba8|r16f|rg16f|rgba16f|r32f|rg32f|rgba32f|"
    "rgb10a2|rg11b10f|rgb9e5|bc1|bc3|bc4|bc5|bc6h|bc7|astc-4x4|astc-8x8";
static const SluiceFormat formats[] = {
    SLUICE_FORMAT_UNDEFINED,
    SLUICE_FORMAT_R8_UNORM,
    SLUICE_FORMAT_R8G8_UNORM,
    SLUICE_FORMAT_R8G8B8A8_UNORM,
    SLUICE_FORMAT_R16_SFLOAT,
    SLUICE_FORMAT_R16G16_SFLOAT,
    SLUICE_FORMAT_R16G16B16A16_SFLOAT,
    SLUICE_FORMAT_R32_SFLOAT,
    SLUICE_FORMAT_R32G32_SFLOAT,
    SLUICE_FORMAT_R32G32B32A32_SFLOAT,
    SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32,
    SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32,
    SLUICE_FORMAT_E5B9G9R9_UFLOAT_PACK32,
    SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK,
    SLUICE_FORMAT_BC3_UNORM_BLOCK,
    SLUICE_FORMAT_BC4_UNORM_BLOCK,
    SLUICE_FORMAT_BC5_UNORM_BLOCK,
    SLUICE_FORMAT_BC6H_UFLOAT_BLOCK,
    SLUICE_FORMAT_BC7_UNORM_BLOCK,
    SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK,
    SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK,
};
static const SluiceBakeQuality qualities[] = {SLUICE_BAKE_QUALITY_FAST, SLUICE_BAKE_QUALITY_NORMAL,
                                              SLUICE_BAKE_QUALITY_BEST};
static const SluiceBakeFilter filters[] = {SLUICE_BAKE_FILTER_BOX, SLUICE_BAKE_FILTER_KAISER};
static const SluiceBakeAlpha alphas[] = {SLUICE_BAKE_ALPHA_AUTO, SLUICE_BAKE_ALPHA_STRAIGHT,
                                         SLUICE_BAKE_ALPHA_PREMULTIPLIED};

_Static_assert(SLUICE_BAKE_DEFAULT_COMPRESSION == 10, "--compression has the library's default");

/* Parsed choices that the settings are computed from. */
struct choices {
    int format, quality, filter, alpha;
    bool srgb, linear;
};

static bool parse_wrap_of_axis(const char *text, size_t length, SluiceBakeWrap *wrap)
{
    static const struct {
        const char *name;
        SluiceBakeWrap wrap;
    } wraps[] = {{"clamp", SLUICE_BAKE_WRAP_CLAMP},
                 {"repeat", SLUICE_BAKE_WRAP_REPEAT},
                 {"mirror", SLUICE_BAKE_WRAP_MIRROR}};
    for (size_t i = 0; i < sizeof wraps / sizeof *wraps; i++)
        if (strlen(wraps[i].name) == length && strncmp(wraps[i].name, text, length) == 0) {
            *wrap = wraps[i].wrap;
            return true;
        }
    return false;
}

/* Parses "both" or "x,y". */
static bool parse_wrap(const char *text, void *value)
{
    SluiceBakeSettings *settings = value;
    size_t length = strcspn(text, ",");
    const char *y = text[length] ? text + length + 1 : text;
    return parse_wrap_of_axis(text, length, &settings->wrapX) &&
           parse_wrap_of_axis(y, strlen(y), &settings->wrapY);
}

static bool parse_compression(const char *text, void *value)
{
    SluiceBakeSettings *settings = value;
    char *end;
    settings->uncompressed = strcmp(text, "none") == 0;
    if (settings->uncompressed)
        return true;
    unsigned long level = strtoul(text, &end, 10);
    settings->compressionLevel = (uint32_t)level;
    return *text >= '0' && *text <= '9' && *end == '\0' && level >= 1 && level <= 22;
}

/* Parses "I/N" with I from 1 to N. */
static bool parse_shard(const char *text, void *value)
{
    struct shard *shard = value;
    unsigned number, count;
    int end = 0;
    if (text[0] < '0' || text[0] > '9' || sscanf(text, "%6u/%6u%n", &number, &count, &end) != 2 ||
        text[end] != '\0' || number < 1 || number > count || count > 100000)
        return false;
    *shard = (struct shard){number, count};
    return true;
}

/* Returns Slurm's number of processors for the task. 0: outside Slurm, use all processors. */
static uint32_t threads_of_task(void)
{
    const char *text = getenv("SLURM_CPUS_PER_TASK");
    unsigned long count = text ? strtoul(text, NULL, 10) : 0;
    return count <= 256 ? (uint32_t)count : 256;
}

static bool parse_cutout(const char *text, void *value)
{
    char *end;
    float *cutout = value;
    *cutout = strtof(text, &end);
    return end != text && *end == '\0' && *cutout > 0.0f && *cutout <= 1.0f;
}

/* sluice-bake writes no pictures. A folder may have a picture's name. */
static bool is_named_as_picture(const char *output)
{
    struct stat status;
    bool is_folder = stat(output, &status) == 0 && S_ISDIR(status.st_mode);
    return files_has_suffix(output, PICTURE_SUFFIXES) && !is_folder;
}

static bool is_folder(const char *path)
{
    struct stat status;
    return path[0] &&
           (path[strlen(path) - 1] == '/' || (stat(path, &status) == 0 && S_ISDIR(status.st_mode)));
}

/* With layers, all named pictures form one store. */
static bool has_one_output(const struct option_table *table, const struct options *o)
{
    const char *option = o->neural ? "--neural" : o->cube ? "--cube" : "--array";
    if (o->verify)
        return options_refuse(table, "%s or --verify, not both; --help says more", option);
    if (is_folder(o->output))
        return options_refuse(table, "-o %s: is a folder; %s makes one file", o->output, option);
    for (size_t i = 0; i < o->inputs.count; i++)
        if (is_folder(o->inputs.items[i]))
            return options_refuse(table, "%s: is a folder; %s takes pictures", o->inputs.items[i],
                                  option);
    return true;
}

static bool is_named_as_store(const char *name)
{
    size_t length = strlen(name);
    return length > 6 && strcmp(name + length - 6, ".store") == 0;
}

/* Plans require a store per picture. Shards and --merge take one plan. */
static bool fits_plan(const struct option_table *table, const struct options *o)
{
    bool is_shard = o->shard.count && !o->merge;
    const char *option = o->plan ? "--plan" : o->merge ? "--merge" : is_shard ? "--shard" : NULL;
    if (!option)
        return true;
    if ((o->plan != NULL) + o->merge + is_shard > 1)
        return options_refuse(table, "--plan, --shard or --merge, one of them; --help says more");
    if (o->cube || o->array || o->neural || o->verify)
        return options_refuse(table,
                              "%s makes no cube maps, arrays or neural sets and verifies "
                              "nothing",
                              option);
    if (!o->plan && o->inputs.count != 1)
        return options_refuse(table, "%s: one plan is needed, which --plan wrote", option);
    if (is_shard && o->output)
        return options_refuse(table, "--shard: the plan says where stores go; leave -o out");
    return true;
}

static bool is_complete(const struct option_table *table, const struct options *o,
                        const struct choices *c)
{
    if (!fits_plan(table, o))
        return false;
    if (o->inputs.count == 1 && ((o->shard.count && !o->merge) || (o->merge && o->output)))
        return true;
    if (o->inputs.count == 0)
        return options_refuse(table, "%s is needed; --help says more",
                              o->verify ? "a file to verify" : "a picture");
    if (o->merge)
        return options_refuse(table, "--merge: -o CATALOGUE is needed");
    if (!o->output && !o->verify)
        return options_refuse(table, "-o is needed: a .store file or a folder; --help says more");
    if (o->output && is_named_as_picture(o->output))
        return options_refuse(table,
                              "-o %s: a tile store is written, not a picture; name it .store, or "
                              "make pictures with sluice-info --png",
                              o->output);
    if (o->output && o->inputs.count > 1 && !(o->cube || o->array || o->neural) &&
        is_named_as_store(o->output) && !is_folder(o->output))
        return options_refuse(table,
                              "-o %s: is the name of one tile store, and there are %zu inputs; end "
                              "it with / for a folder",
                              o->output, (size_t)o->inputs.count);
    if (c->srgb && (c->linear || o->settings.normalMap))
        return options_refuse(table, "--srgb or --%s, not both; --help says more",
                              c->linear ? "linear" : "normal");
    if ((int)o->cube + o->array + o->neural > 1)
        return options_refuse(table, "--cube, --array or --neural, one of them; --help says more");
    if (o->neural && o->batch % 32)
        return options_refuse(table, "--batch %u: is no multiple of 32", o->batch);
    if (o->psnr > 0.0 && o->checkpoint)
        return options_refuse(table, "--psnr or --checkpoint, not both; --help says more");
    return !(o->cube || o->array || o->neural) || has_one_output(table, o);
}

enum option_outcome parse_options(struct options *o, int argc, char **argv)
{
    struct choices c = {.quality = 1};
    SluiceBakeSettings *s = &o->settings;
    *o = (struct options){0};
    const struct option options[] = {
        {OPTION_WORDS, .value = &o->inputs},
        {OPTION_TEXT, "output", "OUT|DIR", "(required)", &o->output,
         "tile store, or folder for tile stores", .letter = 'o'},
        {OPTION_FLAG, "cube", .value = &o->cube,
         .help = "the pictures are faces of a cube map: right, left, top, bottom, front and back "
                 "(+X -X +Y -Y +Z -Z); 12 of two cubes, and so on"},
        {OPTION_FLAG, "array", .value = &o->array,
         .help = "the pictures become layers of one store, in this order"},
        {OPTION_FLAG, "neural", .value = &o->neural,
         .help = "compress the pictures together as one neural set, on a Vulkan device"},
        {OPTION_SECTION, .help = "Texels"},
        {OPTION_CHOICE, "format", format_names, "auto", &c.format,
         "format of the texels; auto: by channels, bit depth and meaning."},
        {OPTION_CHOICE, "quality", "fast|normal|best", "normal", &c.quality,
         "work spent on bc6h, bc7 and astc"},
        {OPTION_FLAG, "srgb", .value = &c.srgb,
         .help = "the numbers are sRGB, as is assumed for integers of two channels or more"},
        {OPTION_FLAG, "linear", .value = &c.linear,
         .help = "the numbers are linear, as is assumed for one channel, floats and normal maps"},
        {OPTION_FLAG, "normal", .value = &s->normalMap,
         .help = "a normal map: levels keep vectors of length 1"},
        {OPTION_FLAG, "keep-primaries", .value = &s->keepPrimaries,
         .help = "keep colors of OpenEXR files as they are, not converted to Rec. 709"},
        {OPTION_CHOICE, "alpha", "auto|straight|premultiplied", "auto", &c.alpha,
         "premultiplied, too, if it is no coverage; auto: straight, for OpenEXR premultiplied"},
        {OPTION_SECTION, .help = "Levels"},
        {OPTION_CHOICE, "filter", "box|kaiser", "box", &c.filter, "filter that makes levels"},
        {OPTION_CUSTOM, "wrap", "X[,Y]", "clamp", s,
         "clamp, repeat or mirror: what kaiser sees beyond edges", .parse = parse_wrap},
        {OPTION_CUSTOM, "cutout", "ALPHA", "(off)", &s->cutout,
         "keep the share of texels with at least this alpha, above 0 and at most 1, in all levels; "
         "reads pictures twice",
         .parse = parse_cutout},
        {OPTION_SECTION, .help = "Neural sets"},
        {OPTION_CHOICE, "bits-per-texel", "1.25|2.5|5|10|20", "5", &o->bits,
         "latents of mip 0, for all channels"},
        {OPTION_REAL, "psnr", "DB", "(off)", &o->psnr,
         "try 1.25 bits per texel, then 2.5 and so on, until mip 0 has this PSNR", 1, 100},
        {OPTION_FLAG, "mask", .value = &o->mask, .help = "fourth channels are masks: keep 0 and 1"},
        {OPTION_TEXT, "loss-weights", "NAME=W,..", "(1 each)", &o->weights,
         "how much the squared errors of a picture count, above 0 and at most 1000; names are "
         "those "
         "of the files, without folder and extension"},
        {OPTION_UINT, "steps", "N", "20000", &o->steps, "steps of training", 20, 10000000},
        {OPTION_UINT, "batch", "N", "65536", &o->batch, "samples of a step, a multiple of 32", 32,
         1048576},
        option_seed(&o->seed),
        {OPTION_TEXT, "checkpoint", "FILE", "(off)", &o->checkpoint,
         "go on from this file if it is there, and write it every minute"},
        {OPTION_FLAG, "progress", .value = &o->progress,
         .help = "print step, PSNR and time left every second"},
        option_device(&o->device),
        {OPTION_SECTION, .help = "Work"},
        {OPTION_CUSTOM, "compression", "LEVEL|none", "10", s, "level of zstd, 1 to 22",
         .parse = parse_compression},
        {OPTION_FLAG, "force", .value = &o->force, .help = "bake also what is up to date"},
        option_threads(&o->threads),
        option_memory(&o->memory, "host memory for all pictures under way"),
        {OPTION_FLAG, "verify", .value = &o->verify,
         .help = "read every tile of stores, of folders all, and compare checksums"},
        option_json(&o->json),
        {OPTION_SECTION, .help = "Several machines (docs/cluster.md)"},
        {OPTION_TEXT, "plan", "PLAN", "(off)", &o->plan,
         "bake nothing; write the list of pictures, settings and estimated work"},
        {OPTION_CUSTOM, "shard", "I/N", "(off)", &o->shard,
         "bake the I-th of N shares of a plan, balanced by estimated work; with --merge: name the "
         "shards to run again",
         .parse = parse_shard, .wanted = "I/N, with I from 1 to N and N at most 100000"},
        {OPTION_FLAG, "merge", .value = &o->merge,
         .help = "check that all stores of a plan are there, and write a catalogue of them"},
    };
    const struct option_table table = {"sluice-bake", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome != OPTIONS_RUN)
        return outcome;
    if (o->threads == 0)
        o->threads = threads_of_task();
    s->format = formats[c.format];
    s->quality = qualities[c.quality];
    s->filter = filters[c.filter];
    s->alpha = alphas[c.alpha];
    if (c.srgb || c.linear)
        s->transfer = c.srgb ? SLUICE_BAKE_TRANSFER_SRGB : SLUICE_BAKE_TRANSFER_LINEAR;
    return is_complete(&table, o, &c) ? OPTIONS_RUN : OPTIONS_ERROR;
}
