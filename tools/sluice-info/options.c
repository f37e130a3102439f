#include "options.h"

#include "../common/shared_options.h"

#include <stdio.h>
#include <string.h>

#define MOST 1048576

static const char usage[] =
    "usage: sluice-info FILE... [--json]\n"
    "       sluice-info FILE [--level N] [--tile X,Y] --png OUT\n"
    "       sluice-info FILE.ntc --decode MIP [--weights int8|fp8] -o OUT\n"
    "       sluice-info [--device INDEX|NAME] [--image WxH] [--json]\n"
    "       sluice-info --formats [--device INDEX|NAME] [--json]\n"
    "       sluice-info --self-test [--report FILE] [--group NAME] [--device INDEX|NAME] [--json]\n"
    "       sluice-info --list-devices\n"
    "\n"
    "Says what is in tile stores, their catalogues, OpenEXR, DDS, KTX2 and .ntc files (neural\n"
    "textures), or, without a file, what the Vulkan devices of this machine can do for Sluice.\n"
    "Options end at --.\n";

static const char notes[] =
    "Of each format of a device: whether it can be streamed, sampled and filtered; the tile as\n"
    "the driver says it, and as it is; how many of the image's levels have tiles that come and\n"
    "go one by one, and how many pages hold the others, in the driver's own mip tail or one by\n"
    "one.\n"
    "\n"
    "--formats says for sparse, paged and dense mode and for demand loading: yes; nearest only,\n"
    "where the device has no linear filter for the format; or why the format is refused.\n"
    "\n"
    "--self-test checks Sluice on a device, for about two minutes: what shaders request, that\n"
    "no sample reads what is not resident, fades, formats, extreme arguments. Send in the file of\n"
    "--report: docs/drivers.md is a table of such reports. Groups: conformance, sampler,\n"
    "residency, fades, formats, extremes.\n"
    "\n"
    "FILE may be a URL of http, https or s3, but for .ntc files. Keys for s3 come from the usual\n"
    "variables: AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY, AWS_SESSION_TOKEN, AWS_REGION and\n"
    "AWS_ENDPOINT_URL. SSL_CERT_FILE names the certificates that are trusted.\n"
    "\n"
    "Exit status: 0 all is shown, and all checks passed; 1 a file cannot be read or written,\n"
    "there is no Vulkan, no device or none of that name, or a check failed; 2 wrong usage.\n";

/* Parses "column,row". */
static bool parse_tile(const char *text, void *value)
{
    struct tile_choice *tile = value;
    int end = -1;
    tile->is_given = true;
    return text[strspn(text, "0123456789,")] == '\0' &&
           sscanf(text, "%7u,%7u%n", &tile->x, &tile->y, &end) == 2 && text[end] == '\0' &&
           tile->x <= MOST && tile->y <= MOST;
}

static bool is_consistent(const struct option_table *table, const struct options *o)
{
    if (o->png && o->files.count != 1)
        return options_refuse(table, "--png takes one file; --help says more");
    if (!o->png && (o->tile.is_given || o->level))
        return options_refuse(table, "--level and --tile go with --png; --help says more");
    if ((o->decode >= 0) != (o->output != NULL))
        return options_refuse(table, "--decode and --output go together; --help says more");
    if (o->decode >= 0 && (o->files.count != 1 || o->png || o->json))
        return options_refuse(table, "--decode takes one file, and no --png or --json");
    if (o->group && !o->self_test)
        return options_refuse(table, "--group goes with --self-test; --help says more");
    if (o->report && !o->self_test)
        return options_refuse(table, "--report goes with --self-test; --help says more");
    if (o->files.count && (o->device || o->list_devices || o->formats || o->self_test))
        return options_refuse(table, "files or devices, not both; --help says more");
    return true;
}

enum option_outcome parse_options(struct options *o, int argc, char **argv)
{
    *o = (struct options){.decode = -1};
    const struct option options[] = {
        {OPTION_WORDS, .value = &o->files},
        {OPTION_SECTION, .help = "Files"},
        {OPTION_TEXT, "png", "OUT", "(none)", &o->png,
         "write a level as a picture; floats are clamped and sRGB-encoded"},
        {OPTION_UINT, "level", "N", "0", &o->level, "level of the picture", 0, 31},
        {OPTION_CUSTOM, "tile", "X,Y", "(the whole level)", &o->tile,
         "only this 64 KiB tile of it: column and row", .parse = parse_tile},
        option_memory(&o->memory, "host memory for the picture and for reading its file"),
        {OPTION_SECTION, .help = "Neural textures"},
        {OPTION_INT, "decode", "MIP", "(none)", &o->decode,
         "decode a mip to floats: [height][width][channels], row 0 first", 0, 31},
        {OPTION_CHOICE, "weights", "int8|fp8", "int8", &o->weights,
         "weights of the network to decode with"},
        {OPTION_TEXT, "output", "OUT", "(none)", &o->output, "file of the floats", .letter = 'o'},
        {OPTION_SECTION, .help = "Devices"},
        {OPTION_TEXT, "device", "INDEX|NAME", "(all)", &o->device,
         "one Vulkan device: an index of --list-devices, or part of its name"},
        option_list_devices(&o->list_devices),
        {OPTION_FLAG, "formats", .value = &o->formats,
         .help = "only the formats: how each residency mode and demand loading streams them"},
        {OPTION_FLAG, "self-test", .value = &o->self_test,
         .help = "check Sluice on one device: the first that streams, or that of --device"},
        {OPTION_TEXT, "group", "NAME", "(all)", &o->group, "only these checks of --self-test"},
        {OPTION_TEXT, "report", "FILE", "(none)", &o->report,
         "write the device and each check of --self-test to a text file"},
        {OPTION_EXTENT, "image", "WxH", "4096x4096", o->image,
         "size of the image whose layout is shown", 1, MOST},
        {OPTION_SECTION, .help = "Output"},
        option_json(&o->json),
    };
    const struct option_table table = {"sluice-info", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    return outcome != OPTIONS_RUN || is_consistent(&table, o) ? outcome : OPTIONS_ERROR;
}
