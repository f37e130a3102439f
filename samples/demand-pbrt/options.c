#include "options.h"

#include <math.h>
#include <stdio.h>

#include "../../tools/common/shared_options.h"
#include "pbrt_shared.h"

static const char usage[] =
    "usage: demand-pbrt SCENE [OPTION ...]\n\n"
    "Renders a scene of pbrt-v3 or pbrt-v4. At first there is one box around the whole scene and\n"
    "nothing else: what rays enter is built, what they hit gets its material, and what the "
    "material\n"
    "shows gets its texels. Launches follow until nothing is missing.\n";

static const char notes[] =
    "Exit status: 0 for a complete picture; 1 if something failed, or pixels are still missing\n"
    "after the last launch; 2 for a wrong option; 77 without a Vulkan device that fits.\n";

/** Parses "r/g/b" or "r,g,b", none negative. */
static bool parse_color(const char *text, void *value)
{
    float *color = value;
    char between[2];
    int end = 0;
    if (sscanf(text, "%f%c%f%c%f%n", &color[0], &between[0], &color[1], &between[1], &color[2],
               &end) != 5 ||
        text[end] != '\0')
        return false;
    for (int i = 0; i < 3; i++)
        if (!(color[i] >= 0.0f) || !isfinite(color[i]))
            return false;
    return (between[0] == '/' || between[0] == ',') && between[0] == between[1];
}

/** Parses "x/y". */
static bool parse_pixel(const char *text, void *value)
{
    uint32_t *pixel = value;
    int end = 0;
    return sscanf(text, "%5u/%5u%n", &pixel[0], &pixel[1], &end) == 2 && text[end] == '\0';
}

static bool is_straight(const float a[3], const float b[3])
{
    float longest = 0.0f;
    for (int i = 0; i < 3; i++)
        longest = fmaxf(longest, fabsf(a[i] * b[(i + 1) % 3] - a[(i + 1) % 3] * b[i]));
    return !(longest > 0.0f);
}

/** Parses "x/y/z/x/y/z" or "x/y/z/x/y/z/x/y/z": eye, point, up. */
static bool parse_view(const char *text, void *value)
{
    struct camera_view *view = value;
    float *const numbers[] = {view->eye, view->look, view->up};
    int count = 0, end = 0;
    for (; count < 9; count++) {
        float *number = &numbers[count / 3][count % 3];
        if (sscanf(text, "%f%n", number, &end) != 1 || !isfinite(*number))
            return false;
        text += end;
        if (*text != '/')
            break;
        text++;
    }
    view->given = true;
    view->has_up = count == 8;
    float way[3];
    bool moves = false;
    for (int i = 0; i < 3; i++) {
        way[i] = view->look[i] - view->eye[i];
        moves = moves || way[i] != 0.0f;
    }
    return *text == '\0' && (count == 5 || count == 8) && moves &&
           !(view->has_up && is_straight(way, view->up));
}

static bool check_devices(const struct option_table *table, const struct pbrt_options *o)
{
    const bool several = o->devices.wanted > 1 || o->devices.count > 1;
    const bool has_launch_pictures = o->sequence || o->contact_sheet;
    if (o->device && (o->devices.wanted > 0 || o->devices.count > 0))
        return options_refuse(table, "--device and --devices: give one of them");
    if (o->split == SPLIT_ALTERNATE && o->animation == 0)
        return options_refuse(table, "--split alternate: is for --animation");
    if ((several || o->animation > 0) && has_launch_pictures)
        return options_refuse(table,
                              "--sequence and --contact-sheet: are for one picture of one device");
    if (several && (o->fly > 0 || o->statistics || o->debug[0] != UINT32_MAX))
        return options_refuse(table, "--fly, --statistics and --debug: are for one device");
    if (o->animation > 0 && (o->fly > 0 || o->fly_at < 1.0 || o->repeat > 0))
        return options_refuse(table, "--animation: not with --fly, --fly-at and --repeat");
    if (o->pictures.given && (o->pictures.first == 0 || o->pictures.last > o->animation))
        return options_refuse(table, "--pictures: those of --animation are 1-%u", o->animation);
    return true;
}

static bool check(const struct option_table *table, const struct pbrt_options *o)
{
    if (!o->scene && !o->list_devices)
        return options_refuse(table, "a scene is missing");
    if (o->texture_budget > 0 && o->texture_budget < 4u << 20)
        return options_refuse(
            table,
            "--texture-budget: the least is 4M (4194304 bytes); 0 is half of the device's memory");
    if (o->preload && o->material_budget > 0)
        return options_refuse(table, "--preload and --material-budget: give one of them");
    if ((o->preload || o->preload_shapes) && o->budget > 0)
        return options_refuse(table, "--preload and --budget: give one of them");
    if (o->preload && o->preload_shapes)
        return options_refuse(table, "--preload and --preload-shapes: give one of them");
    if (o->frame_budget > 0 && o->fly == 0)
        return options_refuse(table, "--frame-budget: is for --fly");
    if (o->fly > 0 && o->fly_at < 1.0)
        return options_refuse(table, "--fly and --fly-at: give one of them");
    if (o->fly_from.given && o->fly == 0 && !(o->fly_at < 1.0) && o->animation == 0)
        return options_refuse(table, "--fly-from: is for --fly, --fly-at and --animation");
    return check_devices(table, o);
}

enum option_outcome pbrt_options_parse(int argc, char **argv, struct pbrt_options *o)
{
    *o = (struct pbrt_options){.debug = {UINT32_MAX, UINT32_MAX}, .warmup = UINT32_MAX};
    const struct option options[] = {
        {OPTION_WORD, .operand = "SCENE", .value = &o->scene, .help = "a scene"},
        {OPTION_SECTION, .help = "Picture"},
        {OPTION_TEXT, "file", "FILE", "demand-pbrt.png", &o->file,
         "the picture: .png, .exr with halves, or .pfm with floats"},
        {OPTION_EXTENT, "dim", "WxH", "(that of the film)", o->dim, "pixels", 1, 16384},
        {OPTION_CUSTOM, "bg", "R/G/B", "(0/0/0)", o->background,
         "background, and what reaches surfaces in the modes near, distant and path",
         .parse = parse_color},
        {OPTION_CHOICE, "render-mode", "primary|near|distant|path", "primary", &o->mode,
         "primary: lights without shadows; near, distant: ambient occlusion within 128 and 10^6 "
         "units; path: paths with shadows"},
        {OPTION_UINT, "samples", "N", "1", &o->samples, "rays per pixel; the first is its center",
         1, 65536},
        {OPTION_UINT, "depth", "N", "3", &o->bounces, "bounces of paths", 0, PBRT_MAX_BOUNCES},
        {OPTION_CUSTOM, "look-from", "EYE/POINT[/UP]", "(that of the scene)", &o->camera,
         "where the camera is, what it looks at, and which way is up: three numbers each, as in "
         "0/-5/2/0/0/0",
         .parse = parse_view},
        {OPTION_FLAG, "face-forward", .value = &o->face_forward,
         .help = "turn normals to the viewer in mode primary"},
        {OPTION_REAL, "exposure", "STOPS", "0", &o->exposure, "of PNG pictures", -16, 16},
        {OPTION_UINT, "animation", "N", "0", &o->animation,
         "render N pictures along the way of --fly, FILE with -0001 and so on before its ending; "
         "0: one picture",
         0, 9999},
        {OPTION_CUSTOM, "pictures", "FIRST-LAST", "(all)", &o->pictures,
         "of --animation only those pictures, the first one is 1: for tasks that share the work",
         .parse = frame_range_parse},

        {OPTION_SECTION, .help = "Loading"},
        {OPTION_FLAG, "preload", .value = &o->preload,
         .help = "load everything first: the truth to compare with"},
        {OPTION_FLAG, "preload-shapes", .value = &o->preload_shapes,
         .help = "build all shapes first; materials and textures on demand"},
        {OPTION_FLAG, "uncompacted", .value = &o->uncompacted,
         .help = "keep the structures of meshes as they were built, to compare with"},
        {OPTION_UINT, "fly", "FRAMES", "0", &o->fly,
         "fly once around the scene first, and tell how long frames took", 0, 1000000},
        {OPTION_CUSTOM, "fly-from", "EYE/POINT[/UP]", "(around the scene)", &o->fly_from,
         "fly from this camera to that of the picture instead", .parse = parse_view},
        {OPTION_REAL, "fly-at", "SHARE", "1", &o->fly_at,
         "the picture is what the camera sees after this share of the way of --fly; 7/96: frame 7 "
         "of 96",
         0, 1},
        {OPTION_REAL, "frame-budget", "MS", "0", &o->frame_budget,
         "time of a frame of --fly: when it is spent, boxes and materials that are asked for wait; "
         "0: no limit",
         0, 100000},
        {OPTION_CHOICE, "proxy-granularity", "fine|coarse", "fine", &o->granularity,
         "fine: each shape of an instance has a box; coarse: those that are alike have one"},
        {OPTION_UINT, "cluster-size", "N", "1024", &o->cluster_size,
         "instances and shapes that one box becomes, at most; boxes of more become boxes of "
         "clusters",
         2, 1000000},
        {OPTION_CHOICE, "path", "auto|pipeline|compute", "auto", &o->path,
         "how rays find what they hit: by the device's ray-tracing pipeline or by a compute "
         "shader, which is slower; auto: the pipeline where there is one"},
        {OPTION_FLAG, "oneshot-geometry", .value = &o->oneshot_geometry,
         .help = "one box per launch becomes what is in it"},
        {OPTION_FLAG, "oneshot-material", .value = &o->oneshot_material,
         .help = "one material per launch is made"},
        {OPTION_FLAG, "sort-proxies", .value = &o->sort_proxies,
         .help = "boxes of the largest volume come first"},
        {OPTION_UINT, "warmup", "N", "(until nothing is missing)", &o->warmup,
         "end after N + 1 launches, whatever is missing", 0, 1000000},
        {OPTION_UINT, "launches", "MAX", "1000", &o->launches, "most launches", 1, 10000000},
        option_budget(&o->budget, "most device memory for meshes; those that rays have not hit for "
                                  "longest become boxes again; 0: no limit"),
        {OPTION_BYTES, "material-budget", "SIZE", "0", &o->material_budget,
         "most device memory for what materials compute, without texels; those that rays have not "
         "hit for longest are asked for again; 0: no limit",
         0, 1099511627776.0},
        {OPTION_BYTES, "texture-budget", "SIZE", "0", &o->texture_budget,
         "most device memory for tiles, 4M or more; 0: half of the device's", 0, 1099511627776.0},
        {OPTION_UINT, "anisotropy", "N", "8", &o->anisotropy, "of textures, at most", 1, 64},
        {OPTION_TEXT, "bounds", "FILE", "(none)", &o->bounds,
         "boxes of PLY files: read if there, and written; later runs read no vertex for them"},
        {OPTION_TEXT, "cache", "DIR", "(beside the picture)", &o->cache,
         "folder for pictures that are baked to tiles"},
        option_threads(&o->threads),
        option_device(&o->device),
        option_devices(&o->devices),
        {OPTION_CHOICE, "split", SPLIT_WORDS, "frame", &o->split, SPLIT_HELP},
        {OPTION_CHOICE, "read-pool", READ_SHARING_WORDS, "auto", &o->read_sharing,
         READ_SHARING_HELP},
        option_list_devices(&o->list_devices),
        option_validation(&o->validation),

        {OPTION_SECTION, .help = "What is told"},
        {OPTION_FLAG, "verbose-loading", .value = &o->verbose_loading,
         .help = "a line for all that is loaded"},
        {OPTION_CUSTOM, "debug", "X/Y", "(none)", o->debug,
         "tell for a pixel of the film what its ray hits, launch by launch", .parse = parse_pixel},
        {OPTION_TEXT, "dump", "FILE", "(none)", &o->dump,
         "write a line for each shape: its box in the world, material, diffuse and alpha"},
        {OPTION_TEXT, "sequence", "DIR", "(none)", &o->sequence,
         "write the picture after each launch here"},
        {OPTION_TEXT, "contact-sheet", "FILE", "(none)", &o->contact_sheet,
         "PNG of small pictures, one for each of the first launches"},
        {OPTION_TEXT, "statistics", "FILE", "(none)", &o->statistics,
         "write counts as JSON, under the names of the OptiX Toolkit's DemandPbrtScene"},
        {OPTION_UINT, "repeat", "N", "0", &o->repeat,
         "trace the complete picture N more times, and tell the best rate", 0, 10000},
        option_json(&o->json),
    };
    const struct option_table table = {"demand-pbrt", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    return outcome != OPTIONS_RUN || check(&table, o) ? outcome : OPTIONS_ERROR;
}
