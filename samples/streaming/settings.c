#include "settings.h"

#include "../../tools/common/shared_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char usage[] =
    "usage: streaming [OPTION ...]\n\n"
    "Walks through a room hung with pictures whose textures are streamed: only the tiles that the\n"
    "frames sample are in GPU memory. Without a window: writes pictures, a CSV line per frame and\n"
    "report.html.\n";

static const char notes[] = "Exit status: 0, also if pictures were left out, which are named on "
                            "stderr; 1 if there is none\n"
                            "to hang or the walk failed; 2 for a wrong option; 77 without a Vulkan "
                            "device that can stream.\n";

#define TILE_SIZE 65536u

/* Reduces the heaps to the budget, rounded down to whole heaps. */
static void keep_to_budget(struct settings *s)
{
    uint32_t tiles = (uint32_t)(s->budget / TILE_SIZE);
    if (s->budget == 0)
        return;
    if (s->heap_tiles > tiles)
        s->heap_tiles = tiles;
    if (s->max_heaps == 0 || s->max_heaps > tiles / s->heap_tiles)
        s->max_heaps = tiles / s->heap_tiles;
}

/** Settings that the truth inherits from the run. */
static bool complete_reference(const struct option_table *table, struct settings *s)
{
    s->reference_anisotropy = s->reference_anisotropy ? s->reference_anisotropy : s->anisotropy;
    s->reference_samples = s->reference_samples ? s->reference_samples : s->samples;
    if (isnan(s->reference_lod_bias))
        s->reference_lod_bias = s->lod_bias;
    if (!s->reference && !s->compare)
        s->metrics_every = 0;
    if (s->reference_samples & (s->reference_samples - 1))
        return options_refuse(table, "--reference-samples %u: wants 1, 2, 4 or 8",
                              s->reference_samples);
    if (s->reference_supersample == 3)
        return options_refuse(table, "--reference-supersample 3: wants 1, 2 or 4");
    if (s->reference && s->compare)
        return options_refuse(table, "--reference: compares instead of --compare, not with it");
    return true;
}

/** Lists each mode once. */
static bool read_neural_modes(const struct option_table *table, struct settings *s)
{
    static const char *const names[NEURAL_MODE_COUNT] = {"raw", "bc7", "load", "feedback",
                                                         "sample"};
    static char first[] = "raw", second[] = "feedback";
    static char *const usual[] = {first, second};
    struct option_list words = s->neural_as.count ? s->neural_as : (struct option_list){usual, 2};
    for (size_t i = 0; i < words.count; i++) {
        uint32_t mode = 0, same = 0;
        while (mode < NEURAL_MODE_COUNT && strcmp(words.items[i], names[mode]) != 0)
            mode++;
        if (mode == NEURAL_MODE_COUNT)
            return options_refuse(table, "--neural-as %s: wants raw, bc7, load, feedback or sample",
                                  words.items[i]);
        while (same < s->neural_mode_count && s->neural_modes[same] != (enum neural_mode)mode)
            same++;
        if (same < s->neural_mode_count)
            return options_refuse(table, "--neural-as: %s twice", names[mode]);
        s->neural_modes[s->neural_mode_count++] = (enum neural_mode)mode;
    }
    return !s->neural || s->images.count == 0 ||
           options_refuse(table, "--neural-set: hangs instead of --images, not with them");
}

/* Checks rules that the option table cannot express. */
static bool check(const struct option_table *table, struct settings *s)
{
    if (s->samples & (s->samples - 1))
        return options_refuse(table, "--samples %u: wants 1, 2, 4 or 8", s->samples);
    if (s->needs_trace && s->needs == THREE_WAY_OFF)
        return options_refuse(table, "--needs-trace: not with --needs off");
    if (s->loads_in_flight == 1)
        return options_refuse(table, "--loads-in-flight 1: wants 2 at least, or 0; a picture's "
                                     "coarsest levels are loaded at once");
    if (s->budget > 0 && s->budget < TILE_SIZE)
        return options_refuse(table, "--budget: wants 64K at least, for one tile, or 0");
    if (s->range.given && s->range.last >= s->frames)
        return options_refuse(table, "--range: frames are 0-%u", s->frames - 1);
    if (s->range.given && (s->needs_trace || s->reference))
        return options_refuse(table, "--range: not with --needs-trace and --reference");
    return read_neural_modes(table, s) && complete_reference(table, s);
}

enum option_outcome settings_parse(int argc, char **argv, struct settings *s)
{
    *s = (struct settings){.reference_lod_bias = NAN};
    const struct option options[] = {
        {OPTION_SECTION, .help = "Pictures"},
        {OPTION_LIST, "images", "FILE|DIR|URL ...", "(a generated set)", &s->images,
         "tile stores, also on servers (give 32 --threads then), OpenEXR, DDS and KTX2 files, "
         "photographs and whatever else libvips reads, copied from servers, "
         "and folders that hold such. Pictures without tiles and levels of their own are baked "
         "into a tile store once"},
        {OPTION_TEXT, "cache", "DIR", "($XDG_CACHE_HOME/sluice, ~/.cache/sluice)", &s->cache,
         "folder for generated pictures and tile stores"},
        {OPTION_UINT, "generate-scale", "N", "1", &s->generate_scale,
         "generated pictures are 1/N as wide and high", 1, 64},
        {OPTION_FLAG, "generate-only", .value = &s->generate_only,
         .help = "end after generating, or baking, the pictures"},
        {OPTION_CHOICE, "format", "auto|rgba16f|rgba8", "auto", &s->format,
         "texels on the GPU; auto: half floats of OpenEXR files, one channel if they are gray, "
         "else sRGB bytes; stores, DDS and KTX2 files keep their format. rgba8: textures that "
         "--neural-as feedback decodes are no blocks"},

        {OPTION_SECTION, .help = "Neural textures"},
        {OPTION_TEXT, "neural-set", "FILE.ntc", "(none)", &s->neural,
         "hang the textures of this set instead of pictures. The pictures that it was made of lie "
         "beside it and have the names of the textures: albedo.png"},
        {OPTION_LIST, "neural-as", "MODE ...", "(raw feedback)", &s->neural_as,
         "how each texture hangs, once for each: raw, texels before compression; bc7, blocks; "
         "load, decoded when a tile is read; feedback, decoded by the GPU when a tile is asked "
         "for; sample, decoded by the shader"},
        {OPTION_UINT, "neural-picks", "N", "1", &s->neural_picks,
         "texels that the shader of sample chooses at random per pixel, and averages", 1, 64},
        {OPTION_CHOICE, "neural-path", "auto|plain|dot|vector|vector-fp8", "auto", &s->neural_path,
         "how the shader of sample runs the network; auto: cooperative vectors where the device "
         "has "
         "them in fragment shaders and the set is of schema 3, else integer dot products where it "
         "has them, else plain. All but vector-fp8 have the same bits"},
        {OPTION_TEXT, "neural-material", "DIR", "(none)", &s->material,
         "write a material of 512 x 512 texels as PNG files, for sluice-bake --neural, and end"},

        {OPTION_SECTION, .help = "Frames"},
        {OPTION_EXTENT, "size", "WxH", "640x360", s->size, "pixels", 16, 8192},
        {OPTION_UINT, "frames", "N", "330", &s->frames, "frames in all", 1, 100000},
        {OPTION_UINT, "rest-frames", "N", "90", &s->rest_frames,
         "frames at the end in which the camera stands still; as many as --frames: it never moves",
         0, 100000},
        {OPTION_UINT, "fps", "N", "60", &s->frames_per_second,
         "frames per second: sets the time step, and frames do not come faster", 1, 10000},
        {OPTION_UINT, "samples", "N", "4", &s->samples, "per pixel along edges: 1, 2, 4 or 8", 1,
         8},
        {OPTION_TEXT, "output", "DIR", "gallery-out", &s->output,
         "folder where everything is written"},
        {OPTION_CUSTOM, "range", "FIRST-LAST", "(all)", &s->range,
         "measure and write these frames alone, in frames-FIRST-LAST.csv and "
         "report-FIRST-LAST.html: for tasks that share the work. Frames before them are played, "
         "as fast as they come. With --deterministic and --threads 1 they are those of one run",
         .parse = frame_range_parse},
        {OPTION_UINT, "play-in", "N", "100000", &s->play_in,
         "play only N frames before --range: sooner there, but no longer the pictures of one run",
         0, 100000},
        {OPTION_CHOICE, "write-frames", "some|all|none", "some", &s->write_frames,
         "pictures to write"},
        {OPTION_FLAG, "deterministic", .value = &s->deterministic,
         .help = "wait for loads in each frame, so that each run is the same"},
        option_seed(&s->seed),

        {OPTION_SECTION, .help = "Streaming"},
        {OPTION_CHOICE, "residency", "auto|sparse|paged|dense", "auto", &s->residency,
         "sparse images, a page table, or memory for everything; auto: sparse where the device "
         "has it, else paged"},
        {OPTION_REAL, "probability", "P", "1/16", &s->probability,
         "probability that a pixel quad writes feedback", 0, 1},
        {OPTION_FLAG, "lattice", .value = &s->lattice,
         .help = "one pixel in 8x8 writes feedback instead, all in turn"},
        {OPTION_UINT, "textures-per-frame", "N", "10", &s->textures_per_frame,
         "feedback maps read back per frame", 1, 65536},
        option_tiles_per_frame(&s->tiles_per_frame, 8192),
        option_timeout(&s->timeout),
        option_standby(&s->standby),
        {OPTION_UINT, "touched-tiles", "N", "0", &s->touched_tiles,
         "most different tiles that are bound, in sparse mode; 0: the device's limit", 0,
         UINT32_MAX},
        option_heap_tiles(&s->heap_tiles),
        option_max_heaps(&s->max_heaps),
        option_budget(&s->budget, "most memory for tiles, in whole heaps; 0: no limit. Paged: page "
                                  "table and coarsest levels are besides; dense: has no effect"),
        option_threads(&s->threads),
        {OPTION_RENAMED, "loader-threads", "threads"},
        {OPTION_CHOICE, "texture-sets", "on|off", "on", &s->texture_sets,
         "on: a picture's relief follows the picture's feedback; off: it writes its own"},
        {OPTION_UINT, "loads-in-flight", "N", "0", &s->loads_in_flight,
         "most tiles that are being read or wait for their upload, 2 or more; 0: 4 times "
         "--tiles-per-frame",
         0, 65536},
        {OPTION_SECONDS, "fade", "SECONDS", "0", &s->fade,
         "time that a texel takes to become one level sharper; 0: at once", 0, 3600},
        {OPTION_MILLISECONDS, "source-latency", "MS", "0", &s->source_latency,
         "time that each read takes longer, whatever else is read meanwhile, in the frames' time "
         "(--fps); no two runs are quite the same then",
         0, 60000},
        {OPTION_REAL, "source-bandwidth", "MB/S", "0", &s->source_bandwidth,
         "10^6 bytes of texels per second of the frames' time that all reads share; 0: no limit", 0,
         1e9},
        {OPTION_UINT, "warm-up", "N", "0", &s->warm_up,
         "frames that go from the entrance before the walk and wait for what they load, as behind "
         "a "
         "loading screen; no figure of time and no line of frames.csv has them, the sums of what "
         "was loaded do",
         0, 1000},
        {OPTION_SECONDS, "predict", "SECONDS", "0", &s->predict,
         "also ask for what the camera will see so much later, if it moves on as it did in the "
         "last frames; 0: do not",
         0, 10},
        {OPTION_TEXT, "record", "TRACE", "(none)", &s->record,
         "record the manager for sluice-replay"},

        {OPTION_SECTION, .help = "Sampling"},
        {OPTION_REAL, "lod-bias", "B", "0", &s->lod_bias, "levels; positive is blurrier", -8, 8},
        {OPTION_UINT, "anisotropy", "N", "1", &s->anisotropy,
         "of the filter, at most; 1: trilinear", 1, 16},
        {OPTION_FLAG, "highlight", .value = &s->highlight,
         .help = "tint what is not yet as sharp as wanted"},

        {OPTION_SECTION, .help = "Checks"},
        {OPTION_FLAG, "compare", .value = &s->compare,
         .help = "draw each frame a second time with everything resident and report the "
                 "difference"},
        {OPTION_TEXT, "reference", "DIR", "(none)", &s->reference,
         "compare with the frames in DIR instead, which are drawn with everything resident before "
         "the walk; only once, unless DIR's were drawn of something else or in another way: to "
         "compare runs with each other, give them the same of the four settings below"},
        {OPTION_UINT, "reference-anisotropy", "N", "0", &s->reference_anisotropy,
         "of the frames in DIR; 0: as --anisotropy", 0, 16},
        {OPTION_REAL, "reference-lod-bias", "B", "(as --lod-bias)", &s->reference_lod_bias,
         "of the frames in DIR", -8, 8},
        {OPTION_UINT, "reference-samples", "N", "0", &s->reference_samples,
         "per pixel along edges in DIR; 0: as --samples", 0, 8},
        {OPTION_UINT, "reference-supersample", "N", "1", &s->reference_supersample,
         "frames in DIR are drawn N times as wide and high, and averaged in linear light: 1, 2 or "
         "4",
         1, 4},
        {OPTION_UINT, "metrics-every", "N", "10", &s->metrics_every,
         "SSIM and FLIP of every Nth frame, the one that differs most and those written, if there "
         "is something to compare with; 0: none",
         0, 100000},
        {OPTION_CHOICE, "compare-with", "auto|sparse|paged|dense", "auto", &s->compare_with,
         "residency of what is compared to; auto: sparse if that is what streams, else dense"},
        {OPTION_CHOICE, "check-residency", "auto|on|off", "auto", &s->check_residency,
         "count samples of texels that are not there; auto: with --compare, where the device can"},
        {OPTION_CHOICE, "needs", "auto|on|off", "auto", &s->needs,
         "find out which tiles each frame needs, and how long they take to show; auto: with "
         "--compare and --reference. Time stamps leave that pass out"},
        {OPTION_TEXT, "needs-trace", "FILE", "(none)", &s->needs_trace,
         "write what each frame needs as an SLTRACE1 trace, for sluice-replay; --needs on"},
        option_validation(&s->validation),
        option_json(&s->json),

        {OPTION_SECTION, .help = "Device"},
        option_device(&s->device),
        option_list_devices(&s->list_devices),
    };
    const struct option_table table = {"streaming", usage, notes, options,
                                       sizeof options / sizeof *options};
    enum option_outcome outcome = options_parse(&table, argc, argv);
    if (outcome != OPTIONS_RUN)
        return outcome;
    if (!check(&table, s))
        return OPTIONS_ERROR;
    keep_to_budget(s);
    if (s->rest_frames > s->frames)
        s->rest_frames = s->frames;
    if (!s->range.given)
        s->range.last = s->frames - 1;
    if (s->play_in > s->range.first)
        s->play_in = s->range.first;
    return OPTIONS_RUN;
}

void settings_report_path(const struct settings *settings, const char *name, const char *ending,
                          char *path, size_t size)
{
    const struct frame_range *range = &settings->range;
    if (range->given)
        snprintf(path, size, "%s/%s-%u-%u%s", settings->output, name, range->first, range->last,
                 ending);
    else
        snprintf(path, size, "%s/%s%s", settings->output, name, ending);
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
