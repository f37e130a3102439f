#include "options.h"

#include "../../tools/common/shared_options.h"

#include <sluice/exr.h>

#include <math.h>
#include <stdio.h>

static const char usage[] =
    "usage: demand-tracer [OPTION ...]\n\n"
    "Traces paths of light through a garden in which everything has a texture of its own, 72 GB "
    "of\n"
    "them without --textures. Nothing is loaded at first: each launch says which tiles it missed,\n"
    "they are loaded, and the pixels that missed them are traced again until none is left.\n";

static const char notes[] =
    "Exit status: 0 for a complete picture; 1 if something failed, or pixels are still missing\n"
    "after --launches; 2 for a wrong option; 77 without a Vulkan device that can do it.\n";

#define LEAST_BUDGET (4u << 20)

_Static_assert(SLUICE_EXR_DEFAULT_MEMORY_BUDGET == (uint64_t)1 << 30, "the default of --memory");

/** Parses "x,y,z,x,y,z": the camera's position and the point it looks at. */
static bool parse_camera(const char *text, void *value)
{
    struct scene_camera *camera = value;
    struct vec3 eye, target;
    int end = 0;
    if (sscanf(text, "%f,%f,%f,%f,%f,%f%n", &eye.x, &eye.y, &eye.z, &target.x, &target.y, &target.z,
               &end) != 6 ||
        text[end] != '\0')
        return false;
    struct vec3 way = vec3_sub(target, eye);
    camera->eye = eye;
    camera->target = target;
    return isfinite(vec3_dot(way, way)) && way.x * way.x + way.z * way.z > 1e-6f;
}

static bool check(const struct option_table *table, struct tracer_options *o)
{
    if (o->budget > 0 && o->budget < LEAST_BUDGET)
        return options_refuse(
            table, "--budget: the least is 4M (4194304 bytes); 0 is half of the device's memory");
    if (o->preview && o->preload)
        return options_refuse(
            table, "--preview and --preload: nothing would be missing; give one of them");
    const bool several = o->devices.wanted > 1 || o->devices.count > 1;
    if (o->device && (o->devices.wanted > 0 || o->devices.count > 0))
        return options_refuse(table, "--device and --devices: give one of them");
    if (o->split == SPLIT_ALTERNATE && o->animation == 0)
        return options_refuse(table, "--split alternate: is for --animation");
    if ((several || o->animation > 0) && (o->launch_pictures || o->contact_sheet))
        return options_refuse(
            table, "--launch-pictures and --contact-sheet: are for one picture of one device");
    if (o->animation > 0 && o->reference)
        return options_refuse(table, "--reference and --animation: give one of them");
    o->needs = o->count_needs != NEEDS_OFF;
    return true;
}

enum option_outcome tracer_options_parse(int argc, char **argv, struct tracer_options *o)
{
    *o = (struct tracer_options){.view = scene_default_camera()};
    const struct option options[] = {
        {OPTION_SECTION, .help = "Textures"},
        {OPTION_LIST, "textures", "FILE|DIR ...", "(computed where they are looked at)",
         &o->textures,
         "OpenEXR files, tile stores, DDS and KTX2 files, and folders that hold such; they go to "
         "the ground and the things in turn"},
        {OPTION_UINT, "texture-count", "N", "200", &o->texture_count,
         "computed textures, a fifth of them leaves", 5, 5000},
        {OPTION_UINT, "texture-size", "N", "8192", &o->texture_size,
         "their width and height in texels", 16, 65536},
        {OPTION_REAL, "anisotropy", "N", "8", &o->anisotropy, "of the filter, at most", 1, 64},

        {OPTION_SECTION, .help = "Picture"},
        {OPTION_EXTENT, "size", "WxH", "960x540", o->size, "pixels", 16, 8192},
        {OPTION_UINT, "samples", "N", "4", &o->samples, "paths per pixel", 1, 65536},
        {OPTION_UINT, "bounces", "N", "1", &o->bounces,
         "of each path, from surface to surface; 0: sun and sky alone", 0, TRACER_MAX_BOUNCES},
        option_seed(&o->seed),
        {OPTION_CUSTOM, "camera", "X,Y,Z,X,Y,Z", "(in front of the garden)", &o->view,
         "where it is and what it looks at, in meters; not straight up or down",
         .parse = parse_camera},
        {OPTION_REAL, "exposure", "STOPS", "0", &o->exposure, "of the PNG picture", -16, 16},
        {OPTION_UINT, "animation", "N", "0", &o->animation,
         "trace N pictures, picture-0001 and so on, while the camera turns once around what it "
         "looks at; 0: one picture",
         0, 9999},

        {OPTION_SECTION, .help = "Launches"},
        {OPTION_CHOICE, "path", "auto|pipeline|compute", "auto", &o->path,
         "how rays find what they hit: by the device's ray-tracing pipeline or by a compute "
         "shader, which is slower; auto: the pipeline where there is one"},
        {OPTION_FLAG, "preview", .value = &o->preview,
         .help = "show coarser levels at once, and do not wait for what is missing"},
        {OPTION_FLAG, "preload", .value = &o->preload,
         .help = "load everything first: the truth to compare with"},
        {OPTION_UINT, "launches", "MAX", "1000", &o->max_launches, "most launches", 1, 10000000},
        {OPTION_UINT, "requests", "N", "0", &o->requests,
         "most tiles that one launch requests; 0: the library's default", 0, 1048576},
        option_budget(&o->budget,
                      "most memory for tiles, 4M or more; 0: half of the device's memory"),
        option_memory(&o->memory, "host memory for OpenEXR files without levels, together; one "
                                  "that does not fit is magenta: bake it (sluice-bake FILE -o "
                                  "DIR)"),
        option_threads(&o->threads),
        option_device(&o->device),
        option_devices(&o->devices),
        {OPTION_CHOICE, "split", SPLIT_WORDS, "frame", &o->split, SPLIT_HELP},
        {OPTION_CHOICE, "read-pool", READ_SHARING_WORDS, "auto", &o->read_sharing,
         READ_SHARING_HELP},
        option_list_devices(&o->list_devices),
        option_validation(&o->validation),

        {OPTION_SECTION, .help = "Output"},
        {OPTION_TEXT, "output", "DIR", "demand-tracer-out", &o->output,
         "folder for picture.png, picture.exr and frames.csv, a row for each launch"},
        {OPTION_TEXT, "launch-pictures", "DIR", "(none)", &o->launch_pictures,
         "also write the picture after each launch here, as PNG and EXR"},
        {OPTION_RENAMED, "frames", "launch-pictures"}, /* this name is a number in the gallery */
        {OPTION_TEXT, "contact-sheet", "FILE", "(none)", &o->contact_sheet,
         "PNG of small pictures, one for each of the first launches; without --preview missing "
         "pixels are magenta"},
        {OPTION_TEXT, "reference", "FILE", "(none)", &o->reference,
         "print PSNR, SSIM and FLIP against a PNG picture of another run, write frame-N.png, "
         "truth-N.png and flip-N.png, N launches"},
        {OPTION_RENAMED, "compare", "reference"}, /* this name is a flag in the gallery */
        {OPTION_CHOICE, "needs", "auto|on|off", "auto", &o->count_needs,
         "count the tiles that the finished picture needed; auto: on"},
        option_json(&o->json),
    };
    const struct option_table table = {"demand-tracer", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    return outcome != OPTIONS_RUN || check(&table, o) ? outcome : OPTIONS_ERROR;
}
