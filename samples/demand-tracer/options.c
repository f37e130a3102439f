#include "options.h"

#include "../../tools/common/text.h"

#include <sluice/exr.h>

#include <math.h>
#include <stdio.h>

static const char usage[] =
    "demand-tracer [OPTION ...]\n\n"
    "Traces paths of light through a garden in which everything has a texture of its own, 72 GB "
    "of\n"
    "them without --textures. Nothing is loaded at first: each launch says which tiles it missed,\n"
    "they are loaded, and the pixels that missed them are traced again until none is left. "
    "Numbers\n"
    "in brackets are defaults.\n"
    "Exit status: 0 for a complete picture; 1 if something failed, or pixels are still missing\n"
    "after --launches; 2 for a wrong option; 77 without a Vulkan device that can do it.\n";

/** "x,y,z,x,y,z": where the camera is, and what it looks at. */
static bool parse_camera(const char *text, struct scene_camera *camera)
{
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

static bool check(struct tracer_options *o)
{
    o->view = scene_default_camera();
    if (o->camera && !parse_camera(o->camera, &o->view)) {
        text_say("--camera %s: wants X,Y,Z,X,Y,Z, and must not look straight up or down",
                 o->camera);
        return false;
    }
    if (o->budget > 0 && o->budget < 4) {
        fprintf(stderr, "--budget %u: wants 4 MiB at least, or 0\n", o->budget);
        return false;
    }
    o->needs = o->count_needs == NEEDS_ON;
    if (o->preview && o->preload) {
        fprintf(stderr, "--preview and --preload: nothing would be missing; give one of them\n");
        return false;
    }
    return true;
}

enum option_outcome tracer_options_parse(int argc, char *const *argv, struct tracer_options *o)
{
    *o = (struct tracer_options){
        .texture_count = 200,
        .texture_size = 8192,
        .size = {960, 540},
        .samples = 4,
        .bounces = 1,
        .max_launches = 1000,
        .seed = 1,
        .anisotropy = 8,
        .memory = SLUICE_EXR_DEFAULT_MEMORY_BUDGET >> 20,
        .output = "demand-tracer-out",
    };
    const struct option options[] = {
        {OPTION_SECTION, .help = "Textures"},
        {OPTION_LIST, "textures", "FILE|DIR ...", &o->textures,
         "OpenEXR files, tile stores, DDS and KTX2 files, and folders\n"
         "that hold such; they go to the ground and the things in turn.\n"
         "Without it textures are computed where they are looked at"},
        {OPTION_UINT, "texture-count", "N", &o->texture_count,
         "computed textures, a fifth of them leaves", 5, 5000},
        {OPTION_UINT, "texture-size", "N", &o->texture_size, "their width and height in texels", 16,
         65536},
        {OPTION_REAL, "anisotropy", "N", &o->anisotropy, "of the filter, at most", 1, 64},

        {OPTION_SECTION, .help = "Picture"},
        {OPTION_SIZE, "size", "WxH", o->size, "pixels", 16, 8192},
        {OPTION_UINT, "samples", "N", &o->samples, "paths per pixel", 1, 65536},
        {OPTION_UINT, "bounces", "N", &o->bounces,
         "of each path, from surface to surface; 0: sun and sky alone", 0, TRACER_MAX_BOUNCES},
        {OPTION_UINT, "seed", "N", &o->seed, "of the scene and of all random numbers", 0,
         4294967295.0},
        {OPTION_TEXT, "camera", "X,Y,Z,X,Y,Z", &o->camera,
         "where it is and what it looks at, in metres"},
        {OPTION_REAL, "exposure", "STOPS", &o->exposure, "of the PNG picture", -16, 16},

        {OPTION_SECTION, .help = "Launches"},
        {OPTION_CHOICE, "path", "auto|pipeline|compute", &o->path,
         "who finds what rays hit: the device's ray-tracing pipeline or\n"
         "a compute shader, which is slower; auto: the pipeline where\n"
         "there is one"},
        {OPTION_FLAG, "preview", NULL, &o->preview,
         "show coarser levels at once, and do not wait for what is missing"},
        {OPTION_FLAG, "preload", NULL, &o->preload,
         "load everything first: the truth to compare with"},
        {OPTION_UINT, "launches", "MAX", &o->max_launches, "launches at most", 1, 10000000},
        {OPTION_UINT, "requests", "N", &o->requests,
         "tiles that one launch may ask for; 0: as many as the library's\ndefault", 0, 1048576},
        {OPTION_UINT, "budget", "MIB", &o->budget,
         "MiB for tiles at most, 4 or more; 0: half of the device's memory", 0, 1048576},
        {OPTION_UINT, "memory", "MIB", &o->memory,
         "MiB of host memory for OpenEXR files without levels, together;\n"
         "one that does not fit is magenta: bake it (sluice-bake FILE -o DIR)",
         1, 1048576},
        {OPTION_UINT, "threads", "N", &o->threads,
         "threads that load; 0: by the number of processors", 0, 256},
        {OPTION_TEXT, "device", "NAME", &o->device,
         "number, or part of the name or type, of the Vulkan device"},
        {OPTION_FLAG, "list-devices", NULL, &o->list_devices, "list the devices and end"},
        {OPTION_FLAG, "validation", NULL, &o->validation,
         "with the validation layers; their messages make the run fail"},

        {OPTION_SECTION, .help = "Output"},
        {OPTION_TEXT, "output", "DIR", &o->output,
         "picture.png, picture.exr and frames.csv, a row for each launch,\nare written here"},
        {OPTION_TEXT, "frames", "DIR", &o->frames,
         "also write the picture after each launch here, as PNG and EXR"},
        {OPTION_TEXT, "contact-sheet", "FILE", &o->contact_sheet,
         "PNG of small pictures, one for each of the first launches;\n"
         "without --preview missing pixels are magenta"},
        {OPTION_TEXT, "compare", "FILE", &o->compare,
         "print PSNR, SSIM and FLIP against a PNG picture of another run,\nwrite frame-N.png, "
         "truth-N.png and flip-N.png, N launches"},
        {OPTION_CHOICE, "needs", "on|off", &o->count_needs,
         "count the tiles that the finished picture needed"},
        {OPTION_FLAG, "json", NULL, &o->json, "a line of JSON for each figure"},
    };
    enum option_outcome outcome =
        options_parse(options, sizeof options / sizeof *options, usage, argc, argv);
    return outcome != OPTIONS_RUN || check(o) ? outcome : OPTIONS_ERROR;
}
