/* Scene: a walk past the textures of a neural set, streamed in five ways (samples/streaming). */
#include "scenes.h"

static const struct scene_setting settings[] = {
    {{"neural-as", "how textures are streamed and where they are decoded", ""},
     "raw",
     "bc7,load,feedback,sample",
     "bc7,load,feedback,sample"},
    {{"neural-picks", "texels that the shader of sample averages per pixel", "texels"},
     "1",
     NULL,
     NULL},
};

static const struct scene_metric metrics[] = {
    {{"psnr_final_db", "dB", "of the last frame to the uncompressed one; 999: equal",
      SWEEP_MORE_IS_BETTER},
     false},
    {{"psnr_mean_db", "dB", "over all frames, also those that still load", SWEEP_MORE_IS_BETTER},
     false},
    {{"flip_final", "", "FLIP of the last frame; 0: equal", SWEEP_LESS_IS_BETTER}, false},
    {{"flip_mean", "", "FLIP, mean over frames", SWEEP_LESS_IS_BETTER}, false},
    {{"texture_bytes_peak", "bytes", "of tiles, latents and weights in GPU memory, at most",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"latent_bytes_peak", "bytes", "of latents and weights alone", SWEEP_LESS_IS_BETTER}, false},
    {{"resident_bytes_peak", "bytes", "of tiles alone, those of floor and walls included",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"file_bytes_read", "bytes", "from the files of the textures", SWEEP_LESS_IS_BETTER}, false},
    {{"frames_to_first_sharp", "frames", "from nothing in memory to about the final PSNR",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"frames_to_final", "frames", "at rest, until the PSNR is that of the end",
      SWEEP_LESS_IS_BETTER},
     false},
    {{"gpu_ms_median", "ms", "of the GPU per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"host_ms_median", "ms", "of the application's thread per frame", SWEEP_LESS_IS_BETTER}, true},
    {{"run_seconds", "s", "that the program took", SWEEP_NEITHER}, true},
};

static const char *const quality[] = {"flip_final", "psnr_final_db", NULL};
static const char *const memory[] = {"texture_bytes_peak", NULL};
static const char *const times[] = {"gpu_ms_median", NULL};

/* The truth has the same filter, so that the error is that of compression. Loads end in each frame,
 * so that the number of frames until sharp does not depend on the machine. */
static void add_repeat_arguments(const struct program *program, uint32_t repeat,
                                 struct text_list *arguments)
{
    text_list_add_parts(arguments, "--compare-with dense --deterministic --json", ' ');
    scene_add_seed(program, repeat, arguments);
}

static void add_run_arguments(const struct program *program, const struct scene_run *run,
                              struct text_list *arguments)
{
    (void)program;
    text_list_add_parts(arguments, "--needs off --write-frames", ' ');
    text_list_add(arguments, run->repeat == 0 ? "some" : "none");
    text_list_add(arguments, "--reference");
    text_list_add(arguments, run->reference);
    text_list_add(arguments, "--output");
    text_list_add(arguments, run->folder);
}

const struct scene scene_neural = {
    .name = "neural",
    .title = "A neural set",
    .program = "../../samples/streaming/streaming",
    .installed = "streaming",
    .settings = settings,
    .metrics = metrics,
    .setting_count = sizeof settings / sizeof *settings,
    .metric_count = sizeof metrics / sizeof *metrics,
    .quick_arguments = "--generate-scale 16 --size 320x180 --samples 1 --frames 100 "
                       "--rest-frames 25 --fps 60 --heap-tiles 8 --standby 0",
    .full_arguments = "--generate-scale 8 --size 640x360 --frames 330 --rest-frames 90 --fps 60 "
                      "--heap-tiles 8 --standby 0",
    .keeps_reference = true,
    .roles = {quality, memory, times},
    .add_run_arguments = add_run_arguments,
    .add_repeat_arguments = add_repeat_arguments,
};
