#include "options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct options defaults = {.width = 4096, .height = 4096};

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

static bool parse_value(struct options *o, const char *name, const char *value)
{
    if (!value || !*value) {
        fprintf(stderr, "sluice-info: %s needs a value\n", name);
        return false;
    }
    if (strcmp(name, "--device") == 0) {
        o->device = value;
        return true;
    }
    if (parse_size(value, &o->width, &o->height))
        return true;
    fprintf(stderr, "sluice-info: --image takes WIDTHxHEIGHT, each from 1 to 1048576, not '%s'\n",
            value);
    return false;
}

bool parse_options(struct options *o, int argc, char **argv)
{
    *o = defaults;
    for (int i = 1; i < argc; i++) {
        const char *name = argv[i];
        if (strcmp(name, "--device") == 0 && (i + 1 == argc || argv[i + 1][0] == '-')) {
            o->list = true;
        } else if (strcmp(name, "--device") == 0 || strcmp(name, "--image") == 0) {
            i++;
            if (!parse_value(o, name, i < argc ? argv[i] : NULL))
                return false;
        } else if (strcmp(name, "--json") == 0) {
            o->json = true;
        } else if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0) {
            o->help = true;
        } else {
            fprintf(stderr, "sluice-info: there is no option %s; --help says more\n", name);
            return false;
        }
    }
    return true;
}

void print_help(void)
{
    printf(
        "usage: sluice-info [options]\n"
        "\n"
        "Says what the Vulkan devices of this machine can do for Sluice.\n"
        "\n"
        "  --device INDEX|NAME  one device, by its number or a part of its name (all)\n"
        "  --device             only the devices' numbers and names\n"
        "  --image WxH          size of the image whose layout is shown (%ux%u)\n"
        "  --json               one JSON object per line and device\n"
        "  --help               this text\n"
        "\n"
        "Of each format: whether it can be streamed, sampled and filtered; the tile as the driver\n"
        "says it, and as it is; how many of the image's levels have tiles that come and go one by\n"
        "one, and how many pages hold the others, in the driver's own mip tail or one by one.\n"
        "\n"
        "Exit status: 0 all is shown; 1 there is no Vulkan, no device or none of that name;\n"
        "2 wrong usage.\n",
        defaults.width, defaults.height);
}
