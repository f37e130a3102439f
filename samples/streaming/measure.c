#include "measure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/output_file.h"

bool measure_begin(struct measure *measure, const struct settings *settings)
{
    *measure = (struct measure){.settings = settings, .file_bytes = NAN};
    measure->frames = calloc(settings->frames, sizeof *measure->frames);
    measure->first_frame = settings->range.first;
    measure->frame_count = settings->range.last + 1;
    measure->rest_frame = settings->frames - settings->rest_frames;
    for (uint32_t i = 0; measure->frames && i < settings->frames; i++)
        measure->frames[i].ssim = measure->frames[i].flip = NAN;
    return measure->frames != NULL;
}

void measure_finish(struct measure *measure)
{
    free(measure->frames);
    *measure = (struct measure){0};
}

uint32_t measure_resident_tiles(const struct frame_record *record)
{
    return record->statistics.mappedTileCount + record->statistics.standbyTileCount;
}

static uint32_t count_frames(const struct measure *measure)
{
    return measure->frame_count - measure->first_frame;
}

/** Returns the first measured frame with a camera at rest. */
static uint32_t first_at_rest(const struct measure *measure)
{
    return measure->rest_frame > measure->first_frame ? measure->rest_frame : measure->first_frame;
}

/** Frames from the camera's stop until the picture stays sharp; NaN: never. */
static double frames_to_sharp(const struct measure *measure)
{
    uint32_t sharp_from = measure->frame_count;
    while (sharp_from > first_at_rest(measure) &&
           measure->frames[sharp_from - 1].psnr >= MEASURE_SHARP_DB)
        sharp_from--;
    return sharp_from < measure->frame_count ? sharp_from - measure->rest_frame : NAN;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/** The value that at most a share `share` of the frames stays below or equals. */
static double quantile(const struct measure *measure, size_t offset, double share)
{
    const uint32_t count = count_frames(measure);
    double *values = calloc(count, sizeof *values);
    if (!values)
        return NAN;
    for (uint32_t i = 0; i < count; i++)
        memcpy(&values[i], (const char *)&measure->frames[measure->first_frame + i] + offset,
               sizeof *values);
    qsort(values, count, sizeof *values, compare_doubles);
    double value = values[(uint32_t)(share * (count - 1))];
    free(values);
    return value;
}

#define FRAME_QUANTILE(measure, field, share)                                                      \
    quantile(measure, offsetof(struct frame_record, field), share)

static double finite_psnr(double psnr)
{
    return psnr > MEASURE_EQUAL_DB ? MEASURE_EQUAL_DB : psnr;
}

static double lowest_psnr(const struct measure *measure)
{
    double lowest = NAN;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
        lowest = fmin(lowest, measure->frames[i].psnr);
    return finite_psnr(lowest);
}

/** PSNR of the mean squared error over all frames. */
static double mean_psnr(const struct measure *measure)
{
    double sum = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
        sum += pow(10, -0.1 * measure->frames[i].psnr);
    return finite_psnr(-10 * log10(sum / count_frames(measure)));
}

/** Summary of SSIM or FLIP over the measured frames. */
struct metric_summary {
    double mean; ///< mean of every Nth frame; other measured frames do not count
    double lowest, highest;
};

static struct metric_summary summarize(const struct measure *measure, size_t offset)
{
    struct metric_summary summary = {0, NAN, NAN};
    uint32_t count = 0, every = measure->settings->metrics_every;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++) {
        double value;
        memcpy(&value, (const char *)&measure->frames[i] + offset, sizeof value);
        summary.lowest = fmin(summary.lowest, value);
        summary.highest = fmax(summary.highest, value);
        if (every > 0 && i % every == 0) {
            summary.mean += value;
            count++;
        }
    }
    summary.mean = count ? summary.mean / count : NAN;
    return summary;
}

static double mean_missing(const struct measure *measure)
{
    double sum = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
        sum += measure->frames[i].missing_percent;
    return sum / count_frames(measure);
}

static double loaded_bytes(const struct measure *measure)
{
    const SluiceVulkanStreamerStatistics *statistics =
        &measure->frames[measure->frame_count - 1].statistics;
    return MEASURE_TILE_BYTES * (double)(statistics->tilesMapped - statistics->tilesRestored);
}

static double needed_bytes_peak(const struct measure *measure)
{
    uint32_t most = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
        if (measure->frames[i].needs.needed_tiles > most)
            most = measure->frames[i].needs.needed_tiles;
    return MEASURE_TILE_BYTES * most;
}

/** Bytes of distinct tiles; NaN if requirements were not counted. */
static double tile_bytes(const struct needs *needs, bool loaded, bool needed)
{
    return needs ? MEASURE_TILE_BYTES * (double)needs_count_tiles(needs, loaded, needed) : NAN;
}

#define FINAL_DB 0.1 ///< tolerance in dB, for the noise of random texels

/** Frames from the camera's stop until the PSNR stays at the last frame's. */
static double frames_to_final(const struct measure *measure)
{
    double last = measure->frames[measure->frame_count - 1].psnr;
    uint32_t from = measure->frame_count;
    while (from > first_at_rest(measure) &&
           finite_psnr(measure->frames[from - 1].psnr) >= finite_psnr(last) - FINAL_DB)
        from--;
    return from < measure->frame_count ? from - measure->rest_frame : NAN;
}

#define FIRST_DB 0.5

/** Frames from the first frame, with empty memory, until the PSNR almost equals the best of the
 * way's first tenth. */
static double frames_to_first_sharp(const struct measure *measure)
{
    uint32_t count = measure->frame_count / 10 > 8 ? measure->frame_count / 10 : 8, frame = 0;
    double best = NAN;
    count = count < measure->frame_count ? count : measure->frame_count;
    for (uint32_t i = 0; i < count; i++)
        best = fmax(best, finite_psnr(measure->frames[i].psnr));
    while (frame < count && finite_psnr(measure->frames[frame].psnr) < best - FIRST_DB)
        frame++;
    return isnan(best) || measure->first_frame > 0 ? NAN : frame;
}

static double last_frames_flip(const struct measure *measure)
{
    return measure->frames[measure->frame_count - 1].flip;
}

/* Figures of a streamed neural set. NaN without a set. */
static uint32_t neural_figures(const struct measure *measure, struct figure *figures)
{
    bool hangs = !isnan(measure->file_bytes);
    double most = 0, beside = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++) {
        const struct frame_record *record = &measure->frames[i];
        double tiles = MEASURE_TILE_BYTES * measure_resident_tiles(record);
        most = fmax(most, tiles + (double)record->neural_bytes);
        beside = fmax(beside, (double)record->neural_bytes);
    }
    const struct figure list[] = {
        {"texture_bytes_peak", hangs ? most : NAN, "bytes",
         "of tiles, latents, pages of latents and weights in GPU memory, the most at a time"},
        {"latent_bytes_peak", hangs ? beside : NAN, "bytes",
         "of latents, pages of latents and weights alone"},
        {"file_bytes_read", measure->file_bytes, "bytes", "from the files of the set"},
        {"frames_to_final", hangs ? frames_to_final(measure) : NAN, "frames",
         "that the camera stands still until the PSNR is within 0.1 dB of the end's"},
        {"frames_to_first_sharp", hangs ? frames_to_first_sharp(measure) : NAN, "frames",
         "from nothing in memory until the PSNR is within 0.5 dB of the best of the first tenth"},
        {"flip_final", hangs ? last_frames_flip(measure) : NAN, "", "FLIP of the last frame"},
    };
    memcpy(figures, list, sizeof list);
    return sizeof list / sizeof *list;
}

/* Figures of loaded and required tiles. */
static uint32_t loaded_figures(const struct measure *measure, struct figure *figures)
{
    const struct needs *needs = measure->needs;
    double needed = needs ? MEASURE_TILE_BYTES * (double)needs->needed_tiles : NAN;
    double loaded = loaded_bytes(measure);
    double idle = tile_bytes(needs, true, false), used = tile_bytes(needs, true, true);
    const struct figure list[] = {
        {"needed_bytes", needed, "bytes",
         "of the tiles that samples of any frame ask for, with all coarser ones, each once"},
        {"needed_bytes_peak", needs ? needed_bytes_peak(measure) : NAN, "bytes",
         "that one frame needs at the most"},
        {"loaded_bytes", loaded, "bytes", "of tiles that were read and mapped, each time"},
        {"loaded_per_needed", loaded / needed, "", "1: only what the walk required"},
        {"loaded_unneeded_bytes", idle, "bytes",
         "of tiles that were loaded and no frame needed; packed levels of all textures are loaded"},
        {"loaded_again_bytes", loaded - idle - used, "bytes", "of tiles, all but the first time"},
        {"needed_unloaded_bytes", tile_bytes(needs, false, true), "bytes",
         "of tiles that were needed, but no longer before they were loaded"},
        {"textures", measure->texture_count, "textures", "that are streamed"},
        {"textures_never_sampled", needs ? needs_count_never_sampled(needs) : NAN, "textures",
         "by no pixel of any frame"},
        {"textures_never_read", measure->reads.never, "textures",
         "without a read from their source; packed levels are read when a texture is added"},
        {"textures_packed_alone", measure->reads.packed, "textures",
         "of which nothing but these packed levels was read"},
    };
    memcpy(figures, list, sizeof list);
    return sizeof list / sizeof *list;
}

/* Figures of the time in which regions were coarser than requested. */
static uint32_t wait_figures(const struct measure *measure, struct figure *figures)
{
    const struct needs_wait *wait = measure->needs ? &measure->needs->wait : NULL;
    const struct figure list[] = {
        {"frames_until_sharp_p50", wait ? needs_wait_quantile(wait, 0.5) : NAN, "frames",
         "from the first that needs a finer level in a region to the first that shows it"},
        {"frames_until_sharp_p99", wait ? needs_wait_quantile(wait, 0.99) : NAN, "frames",
         "99 of 100 are there so soon; one that is in vain counts as long as it was needed"},
        {"frames_until_sharp_mean", wait ? needs_wait_mean(wait) : NAN, "frames",
         "of all waits, with those of no frame at all"},
        {"details_needed", wait ? (double)wait->count : NAN, "details",
         "times that a region needed a finer level than in the frame before"},
        {"details_unmet", wait ? (double)wait->unmet : NAN, "details",
         "of them in vain: no longer needed, or the walk was over, before they were there"},
        {"missing_pixels_percent", mean_missing(measure), "%",
         "of the streamed pixels are coarser than wanted; mean over frames"},
        {"missing_pixels_percent_p99", FRAME_QUANTILE(measure, missing_percent, 0.99), "%",
         "99 of 100 frames have no more"},
    };
    memcpy(figures, list, sizeof list);
    return sizeof list / sizeof *list;
}

uint32_t measure_figures(const struct measure *measure, struct figure figures[MEASURE_MAX_FIGURES])
{
    const struct frame_record *last = &measure->frames[measure->frame_count - 1];
    const SluiceVulkanStreamerStatistics *statistics = &last->statistics;
    uint64_t non_resident = 0, sampled = 0, peak_memory = 0;
    uint32_t peak_tiles = 0;
    for (uint32_t i = measure->first_frame; i < measure->frame_count; i++) {
        const struct frame_record *record = &measure->frames[i];
        non_resident += record->counts.nonResident;
        sampled += record->counts.sampled;
        if (measure_resident_tiles(record) > peak_tiles)
            peak_tiles = measure_resident_tiles(record);
        if (record->statistics.tileMemorySize > peak_memory)
            peak_memory = record->statistics.tileMemorySize;
    }
    struct metric_summary ssim = summarize(measure, offsetof(struct frame_record, ssim));
    struct metric_summary flip = summarize(measure, offsetof(struct frame_record, flip));
    const struct figure list[] = {
        {"pictures", measure->picture_count, "pictures", "that hang in the gallery"},
        {"pictures_left_out", measure->refused_count, "pictures", "that could not be opened"},
        {"virtual_bytes", MEASURE_TILE_BYTES * (double)measure->tile_count, "bytes",
         "of all textures with all their levels, in tiles of 64 KiB"},
        {"resident_bytes", MEASURE_TILE_BYTES * measure_resident_tiles(last), "bytes",
         "of the tiles in memory at the end"},
        {"resident_bytes_peak", MEASURE_TILE_BYTES * peak_tiles, "bytes", "the most at a time"},
        {"budget_bytes", measure->settings->budget ? (double)measure->settings->budget : NAN,
         "bytes", "that heaps may take"},
        {"psnr_final_db", finite_psnr(last->psnr), "dB",
         "of the last frame to everything resident; 999: equal"},
        {"psnr_lowest_db", lowest_psnr(measure), "dB", "of the frame that differs most"},
        {"psnr_mean_db", mean_psnr(measure), "dB", "of the mean squared error over all frames"},
        {"ssim_mean", ssim.mean, "", "of every Nth frame (--metrics-every)"},
        {"ssim_lowest", ssim.lowest, "",
         "of these, the frame that differs most and those written as pictures"},
        {"flip_mean", flip.mean, "", "of every Nth frame: 0, nothing to be seen, to 1"},
        {"flip_worst", flip.highest, "",
         "of these, the frame that differs most and those written as pictures"},
        {"frames_to_60db", frames_to_sharp(measure), "frames",
         "that the camera stands still until the PSNR stays at 60 dB or above"},
        {"resident_tiles_percent", 100.0 * peak_tiles / (double)measure->tile_count, "%",
         "the most at a time, of all tiles"},
        {"resident_tiles_peak", peak_tiles, "tiles", "the most at a time"},
        {"tiles_of_all_textures", (double)measure->tile_count, "tiles", "64 KiB each"},
        {"nonresident_reads", measure->counting ? (double)non_resident : NAN, "samples",
         "that touched a texel that is not there; must be 0"},
        {"checked_pixels", measure->counting ? (double)sampled : NAN, "pixels",
         "that these reads were looked for in"},
        {"tiles_mapped", (double)statistics->tilesMapped, "tiles", "in all, with their texels"},
        {"tiles_unmapped", (double)statistics->tilesUnmapped, "tiles", "in all"},
        {"tiles_canceled", (double)statistics->tilesCanceled, "tiles",
         "wanted no longer before they were loaded"},
        {"tiles_failed", (double)statistics->tilesFailed, "tiles", "failed reads"},
        {"bytes_uploaded", (double)statistics->bytesUploaded, "bytes", "copied to images"},
        {"bytes_read", (double)statistics->bytesRead, "bytes", "delivered by the image files"},
        {"device_memory_peak", (double)peak_memory, "bytes", "heaps, the most at a time"},
        {"device_memory_everything", measure->truth_bytes ? (double)measure->truth_bytes : NAN,
         "bytes", "for everything resident"},
        {"bind_calls", (double)statistics->bindCalls, "calls", "of vkQueueBindSparse"},
        {"feedback_maps", (double)statistics->feedbackMaps, "maps", "read back"},
        {"frames", count_frames(measure), "frames", "in all"},
        {"frame_ms_median", 1e3 * FRAME_QUANTILE(measure, frame_seconds, 0.5), "ms",
         "from submission to submission, with all that is drawn to compare and to count"},
        {"frame_ms_p95", 1e3 * FRAME_QUANTILE(measure, frame_seconds, 0.95), "ms",
         "19 of 20 frames take no longer"},
        {"host_ms_median", 1e3 * FRAME_QUANTILE(measure, host_seconds, 0.5), "ms",
         "of the application's thread, for the streamed picture"},
        {"host_ms_p95", 1e3 * FRAME_QUANTILE(measure, host_seconds, 0.95), "ms",
         "19 of 20 frames take no longer"},
        {"gpu_ms_median", 1e3 * FRAME_QUANTILE(measure, gpu_seconds, 0.5), "ms",
         "of the GPU, for the streamed picture"},
    };
    memcpy(figures, list, sizeof list);
    uint32_t count = sizeof list / sizeof *list;
    count += loaded_figures(measure, figures + count);
    count += neural_figures(measure, figures + count);
    return count + wait_figures(measure, figures + count);
}

static void write_csv_line(FILE *file, const struct measure *measure, uint32_t index)
{
    const struct frame_record *record = &measure->frames[index];
    const SluiceVulkanStreamerStatistics *now = &record->statistics;
    const SluiceVulkanStreamerStatistics *then =
        index > measure->begin_frame ? &measure->frames[index - 1].statistics : &measure->start;
    fprintf(file, "%u,%d,%.3f,%.3f,%.3f,", index, index >= measure->rest_frame,
            1e3 * record->frame_seconds, 1e3 * record->host_seconds, 1e3 * record->gpu_seconds);
    if (!isnan(record->psnr))
        fprintf(file, "%.3f", finite_psnr(record->psnr));
    fprintf(file, ",%u,%u,%u,%u,%u,", measure_resident_tiles(record), now->mappedTileCount,
            now->standbyTileCount, now->requestedTileCount, now->loadsInFlight);
    fprintf(file, "%llu,%llu,%llu,%llu,%llu,",
            (unsigned long long)(now->tilesMapped - then->tilesMapped),
            (unsigned long long)(now->tilesUnmapped - then->tilesUnmapped),
            (unsigned long long)(now->bytesRead - then->bytesRead),
            (unsigned long long)(now->bytesUploaded - then->bytesUploaded),
            (unsigned long long)now->tileMemorySize);
    if (measure->needs && !measure->counting)
        fprintf(file, ",%u,%u,,", record->needs.sampled_pixels, record->needs.missing_pixels);
    else if (measure->counting)
        fprintf(file, "%u,%u,%u,%u,", record->counts.nonResident, record->counts.sampled,
                record->counts.missingPixels, record->counts.missingLevels);
    else
        fprintf(file, ",,,,");
    if (measure->needs)
        fprintf(file, "%u,%u", record->needs.needed_tiles, record->needs.missing_regions);
    else
        fprintf(file, ",");
    if (!isnan(record->flip))
        fprintf(file, ",%.6f,%.6f\n", record->ssim, record->flip);
    else
        fprintf(file, ",,\n");
}

bool measure_write_csv(const struct measure *measure, const char *path)
{
    struct output_file *output = output_file_begin(path);
    if (output) {
        FILE *file = output_file_stream(output);
        fputs("frame,at_rest,frame_ms,host_ms,gpu_ms,psnr_db,resident_tiles,mapped_tiles,"
              "standby_tiles,requested_tiles,loads_in_flight,tiles_mapped,tiles_unmapped,"
              "bytes_read,bytes_uploaded,device_memory,nonresident_reads,sampled_pixels,"
              "missing_pixels,missing_levels,needed_tiles,missing_regions,ssim,flip\n",
              file);
        for (uint32_t i = measure->first_frame; i < measure->frame_count; i++)
            write_csv_line(file, measure, i);
    }
    return output_file_end(output, true);
}

const char *measure_format(double value, char buffer[32])
{
    if (isnan(value))
        return "-";
    if (value == floor(value) && fabs(value) < 1e15)
        snprintf(buffer, 32, "%.0f", value);
    else
        snprintf(buffer, 32, fabs(value) < 1 ? "%.6f" : "%.3f", value);
    return buffer;
}

void measure_print_json(const struct figure *figures, uint32_t count)
{
    char buffer[32];
    for (uint32_t i = 0; i < count; i++)
        printf("{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", figures[i].name,
               !isfinite(figures[i].value) ? "null" : measure_format(figures[i].value, buffer),
               figures[i].unit);
}

void measure_print_text(const struct figure *figures, uint32_t count)
{
    char buffer[32];
    for (uint32_t i = 0; i < count; i++)
        if (!isnan(figures[i].value))
            printf("%-26s %16s %s\n", figures[i].name, measure_format(figures[i].value, buffer),
                   figures[i].unit);
}
