/* Recorded feedback, played against a manager without a device: this tool's own `play`. */
#include "scenes.h"

static const struct scene_setting settings[] = {
    {{"max-heaps", "heaps at most; 0: no cap", ""}, NULL, "4,8", "1,2,4,8,16,32"},
    {{"standby", "tiles kept although unwanted", "tiles"}, NULL, "0", "0,128,256,4096"},
    {{"timeout", "tiles not wanted for so long are let go", "s"}, NULL, "0.1", "0.1,0.25,0.5,2,4"},
    {{"loads-per-frame", "tiles that may be loaded per frame", "tiles"}, NULL, "32", "8,32,64,512"},
    {{"latency", "frames that a load takes", "frames"}, NULL, "8", "0,1,4,8,16"},
};

static const struct scene_metric metrics[] = {
    {{"levels_too_coarse", "levels", "that regions missed, mean", SWEEP_LESS_IS_BETTER}, false},
    {{"missing_percent", "%", "wanted tiles that were not there", SWEEP_LESS_IS_BETTER}, false},
    {{"missing_regions_percent", "%", "regions that miss levels they want", SWEEP_LESS_IS_BETTER},
     false},
    {{"loads", "tiles", "that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"tiles_loaded", "tiles", "that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"loaded_bytes", "bytes", "of the tiles that were loaded", SWEEP_LESS_IS_BETTER}, false},
    {{"loaded_per_needed", "", "tiles loaded for each that was wanted", SWEEP_LESS_IS_BETTER},
     false},
    {{"resident_bytes_peak", "bytes", "the most at a time", SWEEP_LESS_IS_BETTER}, false},
    {{"clairvoyant_tiles", "tiles", "that a policy which knows the future would load",
      SWEEP_NEITHER},
     false},
    {{"clairvoyant_levels_too_coarse", "levels", "that such a policy would miss at this cap",
      SWEEP_NEITHER},
     false},
    {{"core_us_per_frame", "us", "of the manager, per frame", SWEEP_LESS_IS_BETTER}, true},
};

static const char *const quality[] = {"levels_too_coarse", "missing_regions_percent",
                                      "missing_percent", NULL};
static const char *const memory[] = {"resident_bytes_peak", NULL};
static const char *const times[] = {"loaded_bytes", "tiles_loaded", "loads", NULL};

static void add_repeat_arguments(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments)
{
    (void)program;
    (void)repeat;
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
