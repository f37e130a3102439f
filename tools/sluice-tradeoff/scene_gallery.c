/* A walk through a room hung with pictures: samples/streaming. */
#include "scenes.h"

#include <stdlib.h>

#define WARM_UP_FRAMES "20"

static const struct scene_setting settings[] = {
    {{"probability", "that a pixel quad writes feedback", ""},
     "1/16",
     "1/4,1/64,1/256",
     "1,1/4,1/64,1/256,1/1024"},
    {{"lattice", "one pixel in 8x8 writes feedback instead, all in turn", ""}, "off", "on", "on"},
    {{"textures-per-frame", "feedback maps read back per frame", "maps"}, "10", "1", "1,2,5,20"},
    {{"tiles-per-frame", "tiles mapped and uploaded per frame at most", "tiles"},
     "256",
     NULL,
     "8,16,32,64,128,512"},
    {{"timeout", "how long a tile stays requested after it was last seen", "s"},
     "1",
     NULL,
     "0.1,0.25,0.5,2,4"},
    {{"standby", "unrequested tiles kept in memory", "tiles"}, "1024", "0", "0,128,256,4096"},
    {{"budget", "memory for tiles at most; 0: no cap", "MiB"}, "0", "8,16", "32,48,64,96,128,256"},
    {{"residency", "what makes texels resident", ""}, "auto", "paged", "sparse,paged,dense"},
    {{"texture-sets", "a picture's relief follows the picture's feedback", ""}, "on", "off", "off"},
    {{"lod-bias", "added to the level of each sample; positive is blurrier", "levels"},
     "0",
     "1",
     "-1,-0.5,0.5,1,2"},
    /* The base has the truth's filter, so that its error is streaming alone. */
    {{"anisotropy", "of the filter, at most; 1: trilinear", ""}, "16", "1,4", "1,2,4,8"},
    {{"loads-in-flight", "tiles read or waiting for upload, at most; 0: as four frames take",
      "tiles"},
     NULL,
     NULL,
     "8,32,128"},
    {{"source-latency", "that each read takes longer", "ms", true}, NULL, "20", "5,20,50,100"},
    {{"source-bandwidth", "that all reads share; 0: no limit", "MB/s", true},
     NULL,
     NULL,
     "10,50,200"},
    {{"fade", "that a texel takes to become one level sharper; 0: at once", "s"},
     NULL,
     NULL,
     "0.1,0.25,0.5"},
    {{"predict", "that the camera is looked ahead of; 0: not at all", "s"},
     NULL,
     "0.2",
     "0.1,0.2,0.3,0.5"},
};

static const struct scene_metric metrics[] = {
    {{"flip_mean", "", "FLIP to the truth, mean over frames; 0: equal", SWEEP_LESS_IS_BETTER},
     false},
    {{"flip_worst", "", "FLIP of the frame that differs most", SWEEP_LESS_IS_BETTER}, false},
    {{"psnr_mean_db", "dB", "to the truth, over all frames", SWEEP_MORE_IS_BETTER}, false},
    {{"psnr_lowest_db", "dB", "of the frame that differs most", SWEEP_MORE_IS_BETTER}, false},
    {{"psnr_final_db", "dB", "of the last frame; 999: equal", SWEEP_MORE_IS_BETTER}, false},
    {{"ssim_mean", "", "SSIM to the truth, mean over frames; 1: equal", SWEEP_MORE_IS_BETTER},
     false},
    {{"ssim_lowest", "", "of the frame that differs most", SWEEP_MORE_IS_BETTER}, false},
    {{"missing_pixels_percent", "%", "pixels that miss levels they want, mean over frames",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"missing_pixels_percent_p99", "%", "in all but one frame of a hundred no more",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_until_sharp_p50", "frames", "until half of what comes into view is sharp",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_until_sharp_p99", "frames", "until 99 of 100 of it are sharp", SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_until_sharp_mean", "frames", "of all that comes into view", SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_to_60db", "frames", "at rest, until the PSNR stays at 60 dB", SWEEP_LESS_IS_BETTER},
     false},
    {{"resident_bytes_peak", "bytes", "of tiles in memory, the most at a time",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"resident_bytes", "bytes", "of tiles in memory at the end", SWEEP_LESS_IS_BETTER}, false},
    {{"device_memory_peak", "bytes", "of heaps, the most at a time", SWEEP_LESS_IS_BETTER}, false},
    {{"virtual_bytes", "bytes", "of all textures with all their levels", SWEEP_NEITHER}, false},
    {{"needed_bytes", "bytes", "of the tiles that some frame sampled", SWEEP_NEITHER}, false},
    {{"needed_bytes_peak", "bytes", "that one frame needs at the most", SWEEP_NEITHER}, false},
    {{"loaded_bytes", "bytes", "of the tiles that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"loaded_again_bytes", "bytes", "of tiles, all but the first time", SWEEP_LESS_IS_BETTER},
     false},
    {{"loaded_per_needed", "", "tiles loaded for each that some frame sampled",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"textures", "", "in the scene", SWEEP_NEITHER}, false},
    {{"textures_never_sampled", "", "that no frame sampled", SWEEP_NEITHER}, false},
    {{"textures_never_read", "", "of which nothing was read", SWEEP_NEITHER}, false},
    {{"bytes_read", "bytes", "delivered by the image files", SWEEP_LESS_IS_BETTER}, false},
    {{"bytes_uploaded", "bytes", "copied to images", SWEEP_LESS_IS_BETTER}, false},
    {{"tiles_mapped", "tiles", "in all, with their texels", SWEEP_LESS_IS_BETTER}, false},
    {{"tiles_unmapped", "tiles", "in all", SWEEP_LESS_IS_BETTER}, false},
    {{"gpu_ms_median", "ms", "of the GPU per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"host_ms_median", "ms", "of the application's thread per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"frame_ms_median", "ms", "from submission to submission", SWEEP_LESS_IS_BETTER}, true},
    {{"core_us_per_frame", "us", "of the tile manager alone, played from a recording",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"clairvoyant_tiles", "tiles", "that a policy which knows the future would load, from nothing",
      SWEEP_NEITHER},
     false},
    {{"clairvoyant_levels_too_coarse", "levels",
      "that such a policy would miss at this cap, first frames included", SWEEP_NEITHER},
     false},
    {{"run_seconds", "s", "that the program took", SWEEP_NEITHER}, true},
};

static const char *const quality[] = {"flip_mean", "psnr_mean_db", "psnr_lowest_db", NULL};
static const char *const memory[] = {"resident_bytes_peak", "device_memory_peak", NULL};
static const char *const times[] = {"gpu_ms_median", "frame_ms_median", NULL};

static void add_path(const struct program *program, const char *option, const char *folder,
                     const char *name, struct text_list *arguments)
{
    if (!program_has_option(program, option + 2))
        return;
    char *path = memory_text("%s%s%s", folder, *name ? "/" : "", name);
    text_list_add(arguments, option);
    text_list_add(arguments, path);
    free(path);
}

/* Compares all points with one truth, the best that the program can draw, so that filters are
 * compared, too. Its residency mode is fixed, so that it is drawn once. */
static void add_repeat_arguments(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments)
{
    if (program_has_option(program, "reference")) {
        text_list_add_parts(arguments, "--reference-anisotropy 16 --reference-lod-bias 0", ' ');
        if (program_has_option(program, "compare-with"))
            text_list_add_parts(arguments, "--compare-with dense", ' ');
    } else if (program_has_option(program, "compare")) {
        text_list_add(arguments, "--compare");
    }
    /* A walk that begins with nothing in memory shows little else. */
    if (program_has_option(program, "warm-up"))
        text_list_add_parts(arguments, "--warm-up " WARM_UP_FRAMES, ' ');
    scene_add_seed(program, repeat, arguments);
    text_list_add(arguments, "--json");
}

/* The first run writes what is looked at later, and finds out what frames need, for which the
 * device has more to draw; the others only measure. */
static void add_run_arguments(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments)
{
    add_path(program, "--reference", run->reference, "", arguments);
    if (program_has_option(program, "write-frames")) {
        text_list_add(arguments, "--write-frames");
        text_list_add(arguments, run->repeat == 0 ? "some" : "none");
    }
    if (program_has_option(program, "needs")) {
        text_list_add(arguments, "--needs");
        text_list_add(arguments, run->repeat == 0 ? "on" : "off");
    }
    if (run->repeat == 0) {
        add_path(program, "--record", run->folder, "manager.trace", arguments);
        add_path(program, "--needs-trace", run->folder, "needs.trace", arguments);
    }
    add_path(program, "--output", run->folder, "", arguments);
}

const struct scene scene_gallery = {
    .name = "gallery",
    .title = "The gallery",
    .program = "../../samples/streaming/streaming",
    .installed = "streaming",
    .settings = settings,
    .metrics = metrics,
    .setting_count = sizeof settings / sizeof *settings,
    .metric_count = sizeof metrics / sizeof *metrics,
    .quick_arguments =
        "--generate-scale 4 --size 320x180 --samples 1 --frames 100 --rest-frames 25 "
        "--fps 60",
    .full_arguments = "--size 640x360 --frames 330 --rest-frames 90 --fps 60",
    .full_grid = "probability=1/4,1/16,1/64 budget=0,48,96 textures-per-frame=1,10",
    .keeps_reference = true,
    .roles = {quality, memory, times},
    .add_run_arguments = add_run_arguments,
    .add_repeat_arguments = add_repeat_arguments,
};
