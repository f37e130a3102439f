#include "options.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct options defaults = {.width = 4096, .height = 4096, .memory = (uint64_t)1 << 30};

static bool parse_size(const char *text, uint32_t *width, uint32_t *height)
{
    unsigned long w, h;
    char *end;
    w = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end != 'x' || end[1] < '0' || end[1] > '9')
        return false;
    h = strtoul(end + 1, &end, 10);
    if (*end || w == 0 || h == 0 || w > 1u << 20 || h > 1u << 20)
        return false;
    *width = (uint32_t)w;
    *height = (uint32_t)h;
    return true;
}

static bool parse_number(const char *text, char end, uint32_t *value, const char **rest)
{
    char *stop;
    if (*text < '0' || *text > '9')
        return false;
    unsigned long number = strtoul(text, &stop, 10);
    *value = (uint32_t)number;
    *rest = stop + 1;
    return *stop == end && number <= 1u << 20;
}

static bool parse_level(struct options *o, const char *value)
{
    const char *rest;
    if (parse_number(value, '\0', &o->level, &rest) && o->level < 32)
        return true;
    text_say("sluice-info: --level takes a number below 32, not '%s'", value);
    return false;
}

static bool parse_tile(struct options *o, const char *value)
{
    const char *rest;
    o->has_tile =
        parse_number(value, ',', &o->tile_x, &rest) && parse_number(rest, '\0', &o->tile_y, &rest);
    if (!o->has_tile)
        text_say("sluice-info: --tile takes COLUMN,ROW, not '%s'", value);
    return o->has_tile;
}

/* MiB, or with a letter of another unit, as sluice-bake takes it. */
static bool parse_memory(struct options *o, const char *value)
{
    char *end;
    uint32_t shift = 20;
    unsigned long long number = strtoull(value, &end, 10);
    bool is_number = *value >= '0' && *value <= '9' && number > 0 && number <= 1ull << 33;
    if (is_number && (*end == 'K' || *end == 'M' || *end == 'G'))
        shift = *end == 'K' ? 10 : *end == 'M' ? 20 : 30, end++;
    o->memory = (uint64_t)number << shift;
    if (is_number && *end == '\0')
        return true;
    text_say("sluice-info: --memory takes a size like 512M or 2G, not '%s'", value);
    return false;
}

static bool takes_value(const char *name)
{
    static const char *const names[] = {"--device", "--image", "--level",
                                        "--tile",   "--png",   "--memory"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(name, names[i]) == 0)
            return true;
    return false;
}

static bool is_consistent(const struct options *o)
{
    const char *wrong = NULL;
    if (o->png && o->file_count != 1)
        wrong = "--png takes one file";
    else if (!o->png && (o->has_tile || o->level))
        wrong = "--level and --tile go with --png";
    else if (o->file_count && (o->device || o->list))
        wrong = "files or devices, not both";
    if (wrong)
        text_say("sluice-info: %s; --help says more", wrong);
    return !wrong;
}

static bool parse_value(struct options *o, const char *name, const char *value)
{
    if (!value || !*value) {
        text_say("sluice-info: %s needs a value", name);
        return false;
    }
    if (strcmp(name, "--device") == 0) {
        o->device = value;
        return true;
    }
    if (strcmp(name, "--png") == 0) {
        o->png = value;
        return true;
    }
    if (strcmp(name, "--level") == 0)
        return parse_level(o, value);
    if (strcmp(name, "--tile") == 0)
        return parse_tile(o, value);
    if (strcmp(name, "--memory") == 0)
        return parse_memory(o, value);
    if (parse_size(value, &o->width, &o->height))
        return true;
    text_say("sluice-info: --image takes WIDTHxHEIGHT, each from 1 to 1048576, not '%s'", value);
    return false;
}

bool parse_options(struct options *o, int argc, char **argv)
{
    bool only_names = false;
    *o = defaults;
    o->files = argv + 1;
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i];
        if (only_names || name[0] != '-') {
            o->files[o->file_count++] = argv[i];
        } else if (strcmp(name, "--") == 0) {
            only_names = true;
        } else if (strcmp(name, "--device") == 0 && (i + 1 == argc || argv[i + 1][0] == '-')) {
            o->list = true;
        } else if (takes_value(name)) {
            i++;
            if (!parse_value(o, name, i < argc ? argv[i] : NULL))
                return false;
        } else if (strcmp(name, "--json") == 0) {
            o->json = true;
        } else if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
            o->help = true;
        } else {
            text_say("sluice-info: there is no option %s; --help says more", name);
            return false;
        }
    }
    return is_consistent(o);
}

void print_help(void)
{
    printf(
        "usage: sluice-info FILE... [--json]\n"
        "       sluice-info FILE [--level N] [--tile X,Y] --png OUT\n"
        "       sluice-info [--device [INDEX|NAME]] [--image WxH] [--json]\n"
        "\n"
        "Says what is in tile stores, OpenEXR, DDS and KTX2 files, or, without a file, what the\n"
        "Vulkan devices of this machine can do for Sluice.\n"
        "\n"
        "  --png OUT            write a level as a picture; floats are clamped and sRGB-encoded\n"
        "  --level N            which (0)\n"
        "  --tile X,Y           only this 64 KiB tile of it: column and row (the whole level)\n"
        "  --memory SIZE        for the picture and for reading its file, like 512M or 2G (%uG)\n"
        "  --device INDEX|NAME  one device, by its number or a part of its name (all)\n"
        "  --device             only the devices' numbers and names\n"
        "  --image WxH          size of the image whose layout is shown (%ux%u)\n"
        "  --json               one JSON object per line and file or device\n"
        "  --                   what follows are files, also if they begin with -\n"
        "  --help               this text\n"
        "\n"
        "Of each format of a device: whether it can be streamed, sampled and filtered; the tile "
        "as\n"
        "the driver says it, and as it is; how many of the image's levels have tiles that come "
        "and\n"
        "go one by one, and how many pages hold the others, in the driver's own mip tail or one "
        "by\n"
        "one.\n"
        "\n"
        "Exit status: 0 all is shown; 1 a file cannot be read or written, there is no Vulkan, no\n"
        "device or none of that name; 2 wrong usage.\n",
        (unsigned)(defaults.memory >> 30), defaults.width, defaults.height);
}
