/* Scene: recorded feedback that this tool's `play` plays to a manager without a device. */
#include "scenes.h"
static const struct scene_setting settings[] = {
    {{"budget", "memory for all heaps; 0: any amount", "MiB"},
     "0",
     "16,32,64",
     "8,16,32,48,64,96,128,256"},
    {{"standby", "unrequested tiles kept in memory", "tiles"}, NULL, "0", "0,128,256,4096"},
    {{"prefetch-levels", "coarsest levels loaded when nothing is requested", "levels"},
     NULL,
     "4",
     "2,4,6"},
    {{"tiles-per-frame", "loads answered per frame at most", "tiles"}, NULL, "32", "8,32,64,1024"},
    {{"latency", "from handed out to answered", "frames", true}, NULL, "8", "0,1,4,8,16"},
    {{"loads-in-flight", "loads at a time; 0: as many as the latency takes", "tiles"},
     NULL,
     NULL,
     "64,256,1024"},
    {{"timeout", "how long a region stays requested after it was last seen", "s"},
     NULL,
     "0.1",
     "0.1,0.25,0.5,2,4"},
    {{"textures-per-frame", "maps read per frame, in turns; 0: all", "maps"},
     NULL,
     "10",
     "1,2,5,10,20"},
    {{"probability", "that a pixel writes feedback", ""}, "1", "1/16", "1/4,1/16,1/64,1/256"},
    {{"writers", "pixels that see a region", ""}, "64", NULL, "16,256"},
    {{"mip-bias", "added to what maps ask for", "levels"}, NULL, "1", "-1,1,2"},
};

static const struct scene_metric metrics[] = {
    {{"levels_too_coarse", "levels", "of what was sampled, mean", SWEEP_LESS_IS_BETTER}, false},
    {{"regions_too_coarse_percent", "%", "of the regions that were sampled", SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_until_sharp_p50", "frames", "until half of what comes into view is sharp",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_until_sharp_p99", "frames", "until 99 of 100 of it are sharp", SWEEP_LESS_IS_BETTER},
     false},
    {{"wrong_evictions_percent", "%", "regions evicted while they were sampled",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"resident_bytes_peak", "bytes", "of tiles in memory, the most at a time",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"heap_bytes_peak", "bytes", "of heaps, the most at a time", SWEEP_LESS_IS_BETTER}, false},
    {{"virtual_bytes", "bytes", "of all textures with all their levels", SWEEP_NEITHER}, false},
    {{"needed_bytes", "bytes", "of the tiles that some frame sampled", SWEEP_NEITHER}, false},
    {{"loaded_bytes", "bytes", "of the tiles that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"loaded_per_needed", "", "tiles loaded for each that some frame sampled",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"stale_percent", "%", "of the loads were wanted no longer", SWEEP_LESS_IS_BETTER}, false},
    {{"textures", "", "in the trace", SWEEP_NEITHER}, false},
    {{"textures_never_sampled", "", "that no frame sampled", SWEEP_NEITHER}, false},
    {{"host_bytes", "bytes", "of the manager", SWEEP_LESS_IS_BETTER}, false},
    {{"core_us_per_frame", "us", "of the manager, per frame", SWEEP_LESS_IS_BETTER}, false},
    {{"core_us_per_frame_p99", "us", "99 of 100 frames take no longer", SWEEP_LESS_IS_BETTER},
     false},
    {{"clairvoyant_tiles", "tiles", "that a policy which knows the future would load",
      SWEEP_NEITHER},
     false},
    {{"clairvoyant_levels_too_coarse", "levels", "that such a policy would miss at this budget",
      SWEEP_NEITHER},
     false},
};

static const char *const quality[] = {"levels_too_coarse", NULL};
static const char *const memory[] = {"resident_bytes_peak", NULL};
static const char *const times[] = {"loaded_bytes", NULL};

static void add_repeat_arguments(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments)
{
    scene_add_seed(program, repeat, arguments);
    text_list_add(arguments, "--json");
}

static void add_run_arguments(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments)
{
    if (program_has_option(program, "output")) {
        text_list_add(arguments, "--output");
        text_list_add(arguments, run->folder);
    }
}

const struct scene scene_trace = {
    .name = "trace",
    .title = "Recorded feedback",
    .settings = settings,
    .metrics = metrics,
    .setting_count = sizeof settings / sizeof *settings,
    .metric_count = sizeof metrics / sizeof *metrics,
    .quick_arguments = "",
    .full_arguments = "",
    .roles = {quality, memory, times},
    .add_run_arguments = add_run_arguments,
    .add_repeat_arguments = add_repeat_arguments,
};
