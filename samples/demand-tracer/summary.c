#include "summary.h"

#include <math.h>
#include <stdio.h>

#include "../../tools/common/text.h"

#define TILE 65536.0 ///< bytes

struct figure {
    const char *name, *unit;
    double value; ///< NAN: absent
};

/** Sums over all devices, except where noted. */
struct totals {
    SluiceDemandStatistics statistics; ///< `lodBias`: maximum
    double launches, complete, missing, rays, paths, tiles, resident_peak;
    double end;       ///< latest of all devices
    double fill_end;  ///< latest of all devices; infinite: a sample is incomplete
    double first_end; ///< earliest of all devices
    double fill_tiles, fill_paths;
};

/** Size of all textures. Files count once they are open. */
static double virtual_size(const struct summary *s, const struct totals *t)
{
    const struct textures *textures = s->textures;
    return textures->files.count > 0
               ? (double)t->statistics.virtualPageCount / s->device_count * TILE
               : (double)textures->virtual_size;
}

static void print_figure(const struct figure *figure, bool json)
{
    char value[32];
    bool whole = figure->value == floor(figure->value) && fabs(figure->value) < 1e15;
    snprintf(value, sizeof value, whole ? "%.0f" : "%.7g", figure->value);
    if (json)
        printf("{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", figure->name,
               isfinite(figure->value) ? value
               : isinf(figure->value)  ? "1e999"
                                       : "null",
               figure->unit);
    else if (!isnan(figure->value))
        printf("%-22s %16s %s\n", figure->name, value, figure->unit);
}

static void add_statistics(SluiceDemandStatistics *sum, const SluiceDemandStatistics *d)
{
    sum->requestCount += d->requestCount;
    sum->servedCount += d->servedCount;
    sum->restoredCount += d->restoredCount;
    sum->evictedCount += d->evictedCount;
    sum->refusedCount += d->refusedCount;
    sum->failedCount += d->failedCount;
    sum->texturesCreated += d->texturesCreated;
    sum->texturesOpened += d->texturesOpened;
    sum->texturesFailed += d->texturesFailed;
    sum->virtualPageCount += d->virtualPageCount;
    sum->residentTileCount += d->residentTileCount;
    sum->tileMemorySize += d->tileMemorySize;
    sum->deviceMemorySize += d->deviceMemorySize;
    sum->bytesRead += d->bytesRead;
    sum->bytesUploaded += d->bytesUploaded;
    sum->lodBias = d->lodBias > sum->lodBias ? d->lodBias : sum->lodBias;
}

static bool get_statistics(const struct device *d, SluiceDemandStatistics *statistics)
{
    *statistics = (SluiceDemandStatistics){.structSize = sizeof *statistics};
    SluiceResult result = sluiceGetDemandStatistics(d->loader, statistics);
    if (result != SLUICE_SUCCESS)
        text_say("there are no statistics: %s", sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static bool add_device(const struct device *d, struct totals *t)
{
    const struct launches *l = &d->launches;
    SluiceDemandStatistics statistics;
    if (!get_statistics(d, &statistics))
        return false;
    add_statistics(&t->statistics, &statistics);
    t->launches += l->count;
    t->missing += (double)d->missing_count;
    t->rays += (double)l->ray_count;
    t->paths += (double)l->path_count;
    t->tiles += (double)l->tile_count;
    t->resident_peak += (double)d->history.resident_peak;
    t->end = fmax(t->end, d->end);
    if (d->picture_count == 0)
        return true;
    t->complete = fmin(t->complete, l->complete_count);
    t->fill_end = l->fill_end > 0.0 ? fmax(t->fill_end, l->fill_end) : INFINITY;
    t->first_end = fmin(t->first_end, l->fill_end);
    t->fill_tiles += (double)l->fill_count;
    t->fill_paths += (double)l->fill_paths;
    return true;
}

static bool print_device(const struct device *d, bool json)
{
    const struct launches *l = &d->launches;
    SluiceDemandStatistics statistics;
    if (!get_statistics(d, &statistics))
        return false;
    if (json) {
        printf("{\"name\": \"device_%u\", \"value\": ", d->index);
        text_write_json(stdout, d->gpu.properties.deviceName);
        printf(", \"unit\": \"\"}\n");
    }
    const struct figure figures[] = {
        {"launches", "", l->count},
        {"pictures", "", d->picture_count},
        {"paths_traced", "", (double)l->ray_count},
        {"path_rate", "Mpaths/s", 1e-6 * (double)l->path_count / d->busy_seconds},
        {"tiles_loaded", "", (double)l->tile_count},
        {"device_memory", "B", (double)statistics.deviceMemorySize},
        {"time", "s", d->busy_seconds},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++) {
        char name[64];
        snprintf(name, sizeof name, "device_%u_%s", d->index, figures[i].name);
        print_figure(&(struct figure){name, figures[i].unit, figures[i].value}, json);
    }
    return true;
}

/** Returns NAN without elapsed time. */
static double rate(double count, double seconds)
{
    return seconds > 0.0 && count > 0.0 ? count / seconds : NAN;
}

static void print_totals(const struct summary *s, const struct totals *t, bool json)
{
    const SluiceDemandStatistics *d = &t->statistics;
    const double seconds = t->end - s->start;
    const double fill = isfinite(t->fill_end) ? t->fill_end - s->start : NAN;
    const struct figure figures[] = {
        {"devices", "", s->device_count},
        {"ray_tracing_pipeline", "", s->devices[0].renderer.uses_pipeline},
        {"launches", "", t->launches},
        {"samples_complete", "per pixel", t->complete},
        {"pixels_missing", "", t->missing},
        {"paths_traced", "", t->rays},
        {"requests", "pages", (double)d->requestCount},
        {"pages_served", "", (double)d->servedCount},
        {"tiles_restored", "", (double)d->restoredCount},
        {"tiles_evicted", "", (double)d->evictedCount},
        {"requests_refused", "pages", (double)d->refusedCount},
        {"reads_failed", "", (double)d->failedCount},
        {"textures", "", (double)d->texturesCreated / s->device_count},
        {"textures_opened", "", (double)d->texturesOpened},
        {"textures_failed", "", (double)d->texturesFailed},
        {"textures_never_opened", "",
         (double)(d->texturesCreated - d->texturesOpened - d->texturesFailed)},
        {"virtual_bytes", "B", virtual_size(s, t)},
        {"needed_bytes", "B", s->needed_tiles * TILE},
        {"loaded_bytes", "B", t->tiles * TILE},
        {"loaded_per_needed", "", s->needed_tiles > 0 ? t->tiles / s->needed_tiles : NAN},
        {"tiles_resident", "", (double)d->residentTileCount},
        {"resident_bytes", "B", (double)d->residentTileCount * TILE},
        {"resident_bytes_peak", "B", t->resident_peak * TILE},
        {"tile_memory", "B", (double)d->tileMemorySize},
        {"device_memory", "B", (double)d->deviceMemorySize},
        {"bytes_read", "B", (double)d->bytesRead},
        {"bytes_uploaded", "B", (double)d->bytesUploaded},
        {"lod_bias", "levels", d->lodBias},
        {"time", "s", seconds},
        {"path_rate", "Mpaths/s", 1e-6 * rate(t->paths, seconds)},
        {"path_rate_later", "Mpaths/s",
         1e-6 * rate(t->paths - t->fill_paths, t->end - t->first_end)},
        {"fill_time", "s", fill},
        {"fill_rate", "tiles/s", rate(t->fill_tiles, fill)},
        {"psnr", "dB", s->difference.psnr},
        {"ssim_mean", "", s->difference.ssim},
        {"flip_mean", "", s->difference.flip},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        print_figure(&figures[i], json);
}

static void print_pool_figure(const char *name, const char *unit, double value, bool json)
{
    print_figure(&(struct figure){name, unit, value}, json);
}

bool summary_print(const struct summary *s, bool json)
{
    struct totals totals = {.complete = INFINITY, .first_end = INFINITY};
    bool done = true;
    for (uint32_t i = 0; i < s->device_count && done; i++)
        done = add_device(&s->devices[i], &totals);
    if (done)
        print_totals(s, &totals, json);
    if (done)
        read_sharing_print(s->pool, print_pool_figure, json);
    for (uint32_t i = 0; i < s->device_count && s->device_count > 1 && done; i++)
        done = print_device(&s->devices[i], json);
    return done;
}
