/* Scene: a garden whose textures are loaded when rays hit them (samples/demand-tracer). */
#include "scenes.h"

#include <stdlib.h>
#include <unistd.h>

static const struct scene_setting settings[] = {
    {{"budget", "memory for tiles at most; 0: half of the device's", "MiB"},
     "0",
     "4,8",
     "8,16,32,64,128,256"},
    {{"requests", "tiles that one launch may ask for; 0: the library's default", "tiles"},
     "0",
     "64,512",
     "64,256,1024,4096"},
    {{"samples", "paths per pixel", ""}, "4", "1,8", "1,2,8,16"},
    {{"bounces", "of each path", ""}, "1", "0", "0,2,4"},
    {{"anisotropy", "of the filter, at most", ""}, "8", "1", "1,2,4,16"},
    {{"path", "who finds what rays hit", ""}, "auto", "compute", "compute"},
    {{"preview", "coarser levels at once, without a wait for what is missing", ""},
     "off",
     "on",
     "on"},
    {{"preload", "everything is loaded first", ""}, "off", NULL, "on"},
    {{"threads", "that load; 0: by the number of processors", ""}, "0", "1", "1,2,4"},
};

static const struct scene_metric metrics[] = {
    {{"flip_mean", "", "FLIP to the base's picture; 0: equal", SWEEP_LESS_IS_BETTER}, false},
    {{"psnr", "dB", "to the base's picture; 999: equal", SWEEP_MORE_IS_BETTER}, false},
    {{"ssim_mean", "", "SSIM to the base's picture; 1: equal", SWEEP_MORE_IS_BETTER}, false},
    {{"launches", "", "until nothing is missing", SWEEP_LESS_IS_BETTER}, false},
    {{"paths_traced", "paths", "those that were traced again included", SWEEP_LESS_IS_BETTER},
     false},
    {{"pixels_missing", "pixels", "at the end", SWEEP_LESS_IS_BETTER}, false},
    {{"requests", "pages", "that launches asked for", SWEEP_LESS_IS_BETTER}, false},
    {{"tiles_evicted", "tiles", "that made room for others", SWEEP_LESS_IS_BETTER}, false},
    {{"resident_bytes", "bytes", "of tiles in memory at the end", SWEEP_LESS_IS_BETTER}, false},
    {{"resident_bytes_peak", "bytes", "of tiles in memory, the most at a time",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"tile_memory", "bytes", "for tiles", SWEEP_LESS_IS_BETTER}, false},
    {{"device_memory", "bytes", "in all", SWEEP_LESS_IS_BETTER}, false},
    {{"virtual_bytes", "bytes", "of all textures with all their levels", SWEEP_NEITHER}, false},
    {{"needed_bytes", "bytes", "of the tiles that some launch sampled", SWEEP_NEITHER}, false},
    {{"loaded_bytes", "bytes", "of the tiles that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"loaded_per_needed", "", "tiles loaded for each that some launch sampled",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"textures", "", "in the scene", SWEEP_NEITHER}, false},
    {{"textures_opened", "", "that some ray hit", SWEEP_NEITHER}, false},
    {{"bytes_read", "bytes", "delivered by the sources", SWEEP_LESS_IS_BETTER}, false},
    {{"time", "s", "from the first launch to the last", SWEEP_LESS_IS_BETTER}, true},
    {{"run_seconds", "s", "that the program took", SWEEP_NEITHER}, true},
};

static const char *const quality[] = {"flip_mean", "psnr", NULL};
static const char *const memory[] = {"resident_bytes_peak", "resident_bytes", NULL};
static const char *const times[] = {"time", NULL};

/* Repeats keep the seed, because it also makes the scene. */
static void add_repeat_arguments(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments)
{
    (void)program;
    (void)repeat;
    text_list_add(arguments, "--json");
}

/* Uses the base's picture as truth, because pictures are complete with any budget. */
static void add_run_arguments(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments)
{
    char *truth = run->base ? memory_text("%s/picture.png", run->base) : NULL;
    if (truth && access(truth, R_OK) == 0 && program_has_option(program, "reference")) {
        text_list_add(arguments, "--reference");
        text_list_add(arguments, truth);
    }
    if (program_has_option(program, "needs")) { /* counting takes time in each launch */
        text_list_add(arguments, "--needs");
        text_list_add(arguments, run->repeat == 0 ? "on" : "off");
    }
    text_list_add(arguments, "--output");
    text_list_add(arguments, run->folder);
    free(truth);
}

const struct scene scene_demand_tracer = {
    .name = "demand-tracer",
    .title = "The garden of the demand tracer",
    .program = "../../samples/demand-tracer/demand-tracer",
    .installed = "demand-tracer",
    .settings = settings,
    .metrics = metrics,
    .setting_count = sizeof settings / sizeof *settings,
    .metric_count = sizeof metrics / sizeof *metrics,
    .quick_arguments = "--size 192x108 --texture-count 50 --texture-size 4096",
    .full_arguments = "--size 960x540",
    .full_grid = "budget=0,32,128 requests=64,1024",
    .roles = {quality, memory, times},
    .add_run_arguments = add_run_arguments,
    .add_repeat_arguments = add_repeat_arguments,
};
