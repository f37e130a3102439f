/* Any scene and camera path of the viewer: tools/sluice-view. */
#include "scenes.h"

/* Settings that request coarser levels are left out, because no truth is compared. */
static const struct scene_setting settings[] = {
    {{"probability", "that a pixel quad writes feedback", ""}, NULL, "1/64", "1,1/4,1/64,1/256"},
    {{"textures-per-frame", "feedback maps read back per frame", "maps"}, NULL, "1", "1,2,5,20"},
    {{"tiles-per-frame", "tiles that are loaded per frame at most", "tiles"},
     NULL,
     NULL,
     "8,32,64"},
    {{"timeout", "how long a tile stays requested after it was last seen", "s"},
     NULL,
     "0.1",
     "0.1,0.25,0.5,2,4"},
    {{"standby", "unrequested tiles kept in memory", "tiles"}, NULL, NULL, "0,128,256,4096"},
    {{"budget", "memory for tiles at most; 0: no cap", "MiB"}, NULL, "16,64", "16,32,64,128,256"},
    {{"residency", "what makes texels resident", ""}, NULL, NULL, "sparse,paged,dense"},
    {{"loads-in-flight", "tiles read or waiting for upload, at most; 0: as four frames take",
      "tiles"},
     NULL,
     NULL,
     "8,32,128"},
    {{"source-latency", "that each read takes longer", "ms", true}, NULL, NULL, "5,20,50,100"},
    {{"source-bandwidth", "that all reads share; 0: no limit", "MB/s", true},
     NULL,
     NULL,
     "10,50,200"},
    {{"predict", "that the camera is looked ahead of; 0: not at all", "s"},
     NULL,
     "0.2",
     "0.1,0.2,0.3,0.5"},
};

static const struct scene_metric metrics[] = {
    {{"missing_percent_mean", "%", "of what is seen lacks levels it requests, mean over frames",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"missing_percent_p99", "%", "in all but one frame of a hundred no more",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"resident_bytes_peak", "bytes", "of tiles in memory, the most at a time",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"tiles_mapped", "tiles", "in all, with their texels", SWEEP_LESS_IS_BETTER}, false},
    {{"tiles_failed", "tiles", "that could not be read", SWEEP_LESS_IS_BETTER}, false},
    {{"gpu_ms_median", "ms", "of the GPU per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"host_ms_median", "ms", "of the application's thread per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"run_seconds", "s", "that the program took", SWEEP_NEITHER}, true},
};

static const char *const quality[] = {"missing_percent_mean", NULL};
static const char *const memory[] = {"resident_bytes_peak", NULL};
static const char *const times[] = {"gpu_ms_median", NULL};

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
    (void)program;
    (void)run;
    (void)arguments;
}

const struct scene scene_view = {
    .name = "view",
    .title = "A scene of the viewer",
    .program = "../sluice-view/sluice-view",
    .installed = "sluice-view",
    .settings = settings,
    .metrics = metrics,
    .setting_count = sizeof settings / sizeof *settings,
    .metric_count = sizeof metrics / sizeof *metrics,
    .quick_arguments = "--headless --fresh --panels off --size 320x180 --frames 120",
    .full_arguments = "--headless --fresh --panels off --size 640x360 --frames 600",
    .roles = {quality, memory, times},
    .add_run_arguments = add_run_arguments,
    .add_repeat_arguments = add_repeat_arguments,
};
