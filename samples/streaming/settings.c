#include "settings.h"

#include <math.h>
#include <stdio.h>

static const char usage[] =
    "streaming [OPTION ...]\n\n"
    "Walks through a room hung with pictures whose textures are streamed: only the tiles that the\n"
    "frames sample are in GPU memory. Without a window: writes pictures, a CSV line per frame and\n"
    "report.html. Numbers in brackets are defaults.\n"
    "Exit status: 0, also if pictures were left out, which are named on stderr; 1 if there is none "
    "to\n"
    "hang or the walk failed; 2 for a wrong option; 77 without a Vulkan device that can stream.\n";

#define TILES_PER_MEBIBYTE 16u

/* Rounded down to whole heaps. */
static void keep_to_budget(struct settings *s)
{
    uint32_t tiles = s->budget * TILES_PER_MEBIBYTE;
    if (s->budget == 0)
        return;
    if (s->heap_tiles > tiles)
        s->heap_tiles = tiles;
    if (s->max_heaps == 0 || s->max_heaps > tiles / s->heap_tiles)
        s->max_heaps = tiles / s->heap_tiles;
}

/** What the truth takes over from the run. */
static bool complete_reference(struct settings *s)
{
    s->reference_anisotropy = s->reference_anisotropy ? s->reference_anisotropy : s->anisotropy;
    s->reference_samples = s->reference_samples ? s->reference_samples : s->samples;
    if (isnan(s->reference_lod_bias))
        s->reference_lod_bias = s->lod_bias;
    if (!s->reference && !s->compare)
        s->metrics_every = 0;
    if (s->reference_samples & (s->reference_samples - 1))
        fprintf(stderr, "--reference-samples %u: wants 1, 2, 4 or 8\n", s->reference_samples);
    else if (s->reference_supersample == 3)
        fprintf(stderr, "--reference-supersample 3: wants 1, 2 or 4\n");
    else if (s->reference && s->compare)
        fprintf(stderr, "--reference: compares instead of --compare, not with it\n");
    else
        return true;
    return false;
}

enum option_outcome settings_parse(int argc, char *const *argv, struct settings *s)
{
    *s = (struct settings){
        .generate_scale = 1,
        .size = {640, 360},
        .frames = 330,
        .rest_frames = 90,
        .frames_per_second = 60,
        .samples = 4,
        .output = "gallery-out",
        .seed = 1,
        .probability = 1.0 / 16.0,
        .textures_per_frame = 10,
        .tiles_per_frame = 256,
        .timeout = 1.0,
        .standby = 1024,
        .heap_tiles = 256,
        .anisotropy = 1,
        .reference_supersample = 1,
        .reference_lod_bias = NAN,
        .metrics_every = 10,
    };
    const struct option options[] = {
        {OPTION_SECTION, .help = "Pictures"},
        {OPTION_LIST, "images", "FILE|DIR ...", &s->images,
         "tile stores, OpenEXR, DDS and KTX2 files, photographs and\n"
         "whatever else libvips reads, and folders that hold such; what\n"
         "has no tiles and levels of its own is baked into a tile store\n"
         "once; without it a set of large pictures is generated"},
        {OPTION_TEXT, "cache", "DIR", &s->cache,
         "where generated pictures and tile stores are kept\n"
         "[$XDG_CACHE_HOME/sluice, ~/.cache/sluice]"},
        {OPTION_UINT, "generate-scale", "N", &s->generate_scale,
         "generated pictures are 1/N as wide and high", 1, 64},
        {OPTION_FLAG, "generate-only", NULL, &s->generate_only,
         "end after generating, or baking, the pictures"},
        {OPTION_CHOICE, "format", "auto|rgba16f|rgba8", &s->format,
         "texels on the GPU; auto: half floats of OpenEXR files, one\n"
         "channel if they are grey, else sRGB bytes; stores, DDS and KTX2\n"
         "files stay what they are"},

        {OPTION_SECTION, .help = "Frames"},
        {OPTION_SIZE, "size", "WxH", s->size, "pixels", 16, 8192},
        {OPTION_UINT, "frames", "N", &s->frames, "frames in all", 1, 100000},
        {OPTION_UINT, "rest-frames", "N", &s->rest_frames,
         "so many of them at the end, in which the camera stands still;\nas many as there are: it "
         "never moves",
         0, 100000},
        {OPTION_UINT, "fps", "N", &s->frames_per_second,
         "frames per second: sets the time step, and frames do not come\nfaster", 1, 10000},
        {OPTION_UINT, "samples", "N", &s->samples, "per pixel along edges: 1, 2, 4 or 8", 1, 8},
        {OPTION_TEXT, "output", "DIR", &s->output, "where everything is written"},
        {OPTION_CHOICE, "write-frames", "some|all|none", &s->write_frames, "pictures to write"},
        {OPTION_FLAG, "deterministic", NULL, &s->deterministic,
         "wait for loads in each frame, so that each run is the same"},
        {OPTION_UINT, "seed", "N", &s->seed, "of the random choice of pixels", 0, 4294967295.0},

        {OPTION_SECTION, .help = "Streaming"},
        {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", &s->residency,
         "what makes texels resident: sparse images, a page table, or\nmemory for everything; "
         "auto: "
         "sparse where the device has it,\nelse paged"},
        {OPTION_REAL, "probability", "P", &s->probability,
         "that a pixel quad writes feedback; 1/16 is understood", 0, 1},
        {OPTION_FLAG, "lattice", NULL, &s->lattice,
         "one pixel in 8x8 writes feedback instead, all in turn"},
        {OPTION_UINT, "textures-per-frame", "N", &s->textures_per_frame,
         "feedback maps read back per frame", 1, 65536},
        {OPTION_UINT, "tiles-per-frame", "N", &s->tiles_per_frame,
         "tiles mapped and uploaded per frame at most", 1, 8192},
        {OPTION_REAL, "timeout", "SECONDS", &s->timeout,
         "how long a tile stays requested after it was last seen", 0.001, 86400},
        {OPTION_UINT, "standby", "N", &s->standby, "unrequested tiles kept in memory", 0,
         4294967295.0},
        {OPTION_UINT, "touched-tiles", "N", &s->touched_tiles,
         "different tiles bound at most, in sparse mode; 0: the device's limit", 0, 4294967295.0},
        {OPTION_UINT, "heap-tiles", "N", &s->heap_tiles, "tiles of 64 KiB per heap", 1, 1048576},
        {OPTION_UINT, "max-heaps", "N", &s->max_heaps, "heaps at most; 0: no cap", 0, 65536},
        {OPTION_UINT, "budget", "MIB", &s->budget,
         "MiB for tiles at most, in whole heaps; 0: no cap. Paged: page\n"
         "table and coarsest levels are besides; dense: has all in memory",
         0, 1048576},
        {OPTION_UINT, "loader-threads", "N", &s->loader_threads,
         "threads that read tiles; 0: by the number of processors", 0, 256},
        {OPTION_CHOICE, "texture-sets", "on|off", &s->texture_sets,
         "on: a picture's relief follows the picture's feedback;\noff: it writes its own"},
        {OPTION_UINT, "loads-in-flight", "N", &s->loads_in_flight,
         "tiles being read or waiting for their upload at most, 2 or more;\n0: 4 times "
         "--tiles-per-frame",
         0, 65536},
        {OPTION_REAL, "fade", "SECONDS", &s->fade,
         "that a texel takes to become one level sharper; 0: at once", 0, 3600},
        {OPTION_REAL, "source-latency", "MS", &s->source_latency,
         "that each read takes longer, whatever else is read meanwhile, in\n"
         "the frames' time (--fps); no two runs are quite the same then",
         0, 60000},
        {OPTION_REAL, "source-bandwidth", "MB/S", &s->source_bandwidth,
         "10^6 bytes of texels per second of the frames' time that all\nreads share; 0: no limit",
         0, 1e9},
        {OPTION_UINT, "warm-up", "N", &s->warm_up,
         "so many frames from the entrance go before the walk, and wait for\n"
         "what they load, as behind a loading screen; no figure of time and\n"
         "no line of frames.csv has them, the sums of what was loaded do",
         0, 1000},
        {OPTION_REAL, "predict", "SECONDS", &s->predict,
         "also ask for what the camera will see so much later, if it\nmoves on as it did in the "
         "last "
         "frames; 0: do not",
         0, 10},
        {OPTION_TEXT, "record", "TRACE", &s->record, "record the manager for sluice-replay"},

        {OPTION_SECTION, .help = "Sampling"},
        {OPTION_REAL, "lod-bias", "B", &s->lod_bias, "levels; positive is blurrier", -8, 8},
        {OPTION_UINT, "anisotropy", "N", &s->anisotropy, "1: trilinear", 1, 16},
        {OPTION_FLAG, "highlight", NULL, &s->highlight, "tint what is not yet as sharp as wanted"},

        {OPTION_SECTION, .help = "Checks"},
        {OPTION_FLAG, "compare", NULL, &s->compare,
         "draw each frame a second time with everything resident and\nreport the difference"},
        {OPTION_TEXT, "reference", "DIR", &s->reference,
         "compare with the frames in DIR instead, which are drawn with\n"
         "everything resident before the walk; only once, unless DIR's\n"
         "were drawn of something else or in another way: to compare runs\n"
         "with each other, give them the same of the four settings below"},
        {OPTION_UINT, "reference-anisotropy", "N", &s->reference_anisotropy,
         "of the frames in DIR; 0: as --anisotropy", 0, 16},
        {OPTION_REAL, "reference-lod-bias", "B", &s->reference_lod_bias,
         "of the frames in DIR; without it as --lod-bias", -8, 8},
        {OPTION_UINT, "reference-samples", "N", &s->reference_samples,
         "per pixel along edges in DIR; 0: as --samples", 0, 8},
        {OPTION_UINT, "reference-supersample", "N", &s->reference_supersample,
         "frames in DIR are drawn N times as wide and high, and averaged\nin linear light: 1, 2 or "
         "4",
         1, 4},
        {OPTION_UINT, "metrics-every", "N", &s->metrics_every,
         "SSIM and FLIP of every Nth frame, the one that differs most and\n"
         "those written, if there is something to compare with; 0: none",
         0, 100000},
        {OPTION_CHOICE, "compare-with", "auto|sparse|paged|dense", &s->compare_with,
         "residency of what is compared to; auto: sparse if that is what\nstreams, else dense"},
        {OPTION_CHOICE, "check-residency", "auto|on|off", &s->check_residency,
         "count samples of texels that are not there; auto: with\n--compare, where the device can"},
        {OPTION_CHOICE, "needs", "auto|on|off", &s->needs,
         "find out which tiles each frame needs, and how long they take to\n"
         "show; auto: with --compare and --reference. Time stamps leave\nthat pass out"},
        {OPTION_TEXT, "needs-trace", "FILE", &s->needs_trace,
         "write what each frame needs as an SLTRACE1 trace, for\nsluice-replay; --needs on"},
        {OPTION_FLAG, "validation", NULL, &s->validation,
         "Vulkan's validation layers; any message is an error"},
        {OPTION_FLAG, "json", NULL, &s->json, "figures as JSON lines on stdout"},

        {OPTION_SECTION, .help = "Device"},
        {OPTION_TEXT, "device", "INDEX|NAME", &s->device, "instead of the best one"},
        {OPTION_FLAG, "list-devices", NULL, &s->list_devices, "list them and end"},
    };
    enum option_outcome outcome =
        options_parse(options, sizeof options / sizeof *options, usage, argc, argv);
    if (outcome == OPTIONS_RUN && (s->samples & (s->samples - 1))) {
        fprintf(stderr, "--samples %u: wants 1, 2, 4 or 8\n", s->samples);
        return OPTIONS_ERROR;
    }
    if (outcome == OPTIONS_RUN && s->needs_trace && s->needs == THREE_WAY_OFF) {
        fprintf(stderr, "--needs-trace: not with --needs off\n");
        return OPTIONS_ERROR;
    }
    if (outcome == OPTIONS_RUN && s->loads_in_flight == 1) {
        fprintf(stderr, "--loads-in-flight 1: wants 2 at least, or 0; a picture's coarsest levels "
                        "are loaded at once\n");
        return OPTIONS_ERROR;
    }
    if (outcome == OPTIONS_RUN && !complete_reference(s))
        return OPTIONS_ERROR;
    keep_to_budget(s);
    if (outcome == OPTIONS_RUN && s->rest_frames > s->frames)
        s->rest_frames = s->frames;
    return outcome;
}

SluiceResidencyMode settings_residency_mode(int residency)
{
    switch ((enum residency)residency) {
    case RESIDENCY_AUTO: return SLUICE_RESIDENCY_MODE_AUTO;
    case RESIDENCY_SPARSE: return SLUICE_RESIDENCY_MODE_SPARSE;
    case RESIDENCY_PAGED: return SLUICE_RESIDENCY_MODE_PAGED;
    case RESIDENCY_DENSE: return SLUICE_RESIDENCY_MODE_DENSE;
    }
    return SLUICE_RESIDENCY_MODE_AUTO;
}

bool settings_find_needs(const struct settings *settings)
{
    return settings->needs == THREE_WAY_ON || settings->needs_trace ||
           (settings->needs == THREE_WAY_AUTO && (settings->compare || settings->reference));
}
