#include "oracle/options.h"

#include "../../tools/common/shared_options.h"

#include <stdio.h>

static const char USAGE[] =
    "usage: pbrt_oracle SCENE [OPTION ...]\n\n"
    "Casts the rays of a pbrt scene's camera with Embree, everything loaded: what other renderers\n"
    "of Sluice are compared with. Without --file, --hits and --compare it only counts.\n";

static const char NOTES[] =
    "--render-mode cast counts what one ray through the center of each pixel hits. primary is the\n"
    "preview of demand-pbrt, direct is direct light with shadows, path is --bounces more.\n\n"
    "Exit status: 0; 1 if something failed; 2 for a wrong option.\n";

/* "R/G/B" */
static bool parse_color(const char *text, void *value)
{
    float *color = value;
    int end = 0;
    return sscanf(text, "%f/%f/%f%n", &color[0], &color[1], &color[2], &end) == 3 && !text[end] &&
           color[0] >= 0 && color[1] >= 0 && color[2] >= 0;
}

enum option_outcome oracle_options_parse(int argc, char **argv, struct oracle_options *o)
{
    struct oracle_settings *s = &o->settings;
    *o = (struct oracle_options){0};
    const struct option options[] = {
        {OPTION_WORD, .operand = "SCENE", .value = &o->scene, .help = "a scene", .minimum = 1},
        {OPTION_CHOICE, "render-mode", "cast|primary|direct|path", "cast", &s->mode,
         "what is computed"},
        {OPTION_EXTENT, "dim", "WxH", "(that of the film)", s->dim, "pixels", 1, 16384},
        {OPTION_UINT, "samples", "N", "1", &s->samples, "rays per pixel; the first is its center",
         1, 65536},
        {OPTION_UINT, "bounces", "N", "3", &s->bounces, "of mode path", 0, 64},
        {OPTION_CUSTOM, "bg", "R/G/B", "(0/0/0)", s->background,
         "background, and light from everywhere", .parse = parse_color},
        {OPTION_FLAG, "face-forward", .value = &s->face_forward,
         .help = "turn normals to the viewer in mode primary"},
        {OPTION_FLAG, "nearest", .value = &s->nearest,
         .help = "take the nearest texel of pictures instead of filtering"},
        option_seed(&s->seed),
        {OPTION_TEXT, "file", "FILE", "(none)", &o->file,
         "the picture: .pfm, or .png clamped at 1"},
        {OPTION_TEXT, "hits", "FILE", "(none)", &o->hits,
         "write a line for each pixel: shape, instance, triangle, distance, barycentrics, normal, "
         "uv"},
        {OPTION_TEXT, "places", "FILE", "(none)", &o->places,
         "write a line for each shape in the world: visible, entered, box"},
        {OPTION_FLAG, "tiles", .value = &o->tiles,
         .help = "count the tiles of pictures that the hits sample, without anisotropy: at least, "
                 "exactly and at most"},
        {OPTION_TEXT, "compare", "FILE", "(none)", &o->compare,
         "compare with a picture: .pfm, .exr or .png"},
        {OPTION_FLAG, "quiet", .value = &s->is_quiet, .help = "no warnings about the scene"},
        option_json(&o->json),
    };
    const struct option_table table = {"pbrt_oracle", USAGE, NOTES, options,
                                       sizeof options / sizeof *options};
    return options_parse(&table, argc, argv);
}
