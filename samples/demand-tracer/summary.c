#include "summary.h"

#include <math.h>
#include <stdio.h>

#define TILE 65536.0 ///< bytes

struct figure {
    const char *name, *unit;
    double value; ///< NAN: not there
};

/** Of files it is known once they are open. */
static double virtual_size(const struct summary *s)
{
    const struct textures *textures = s->launches->textures;
    return textures->files.count > 0 ? (double)s->statistics.virtualPageCount * TILE
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

void summary_print(const struct summary *s, bool json)
{
    const struct launches *l = s->launches;
    const SluiceDemandStatistics *d = &s->statistics;
    const struct figure figures[] = {
        {"ray_tracing_pipeline", "0 or 1", l->renderer->uses_pipeline},
        {"launches", "", l->count},
        {"samples_complete", "per pixel", l->complete_count},
        {"pixels_missing", "", l->film->missing_count},
        {"paths_traced", "", (double)l->ray_count},
        {"requests", "pages", (double)d->requestCount},
        {"pages_served", "", (double)d->servedCount},
        {"tiles_restored", "", (double)d->restoredCount},
        {"tiles_evicted", "", (double)d->evictedCount},
        {"requests_refused", "pages", (double)d->refusedCount},
        {"reads_failed", "", (double)d->failedCount},
        {"textures", "", (double)d->texturesCreated},
        {"textures_opened", "", (double)d->texturesOpened},
        {"textures_failed", "", (double)d->texturesFailed},
        {"textures_never_opened", "",
         (double)(d->texturesCreated - d->texturesOpened - d->texturesFailed)},
        {"virtual_bytes", "B", virtual_size(s)},
        {"needed_bytes", "B", s->needed_tiles * TILE},
        {"loaded_bytes", "B", (double)l->tile_count * TILE},
        {"loaded_per_needed", "",
         s->needed_tiles > 0 ? (double)l->tile_count / s->needed_tiles : NAN},
        {"tiles_resident", "", (double)d->residentTileCount},
        {"resident_bytes", "B", (double)d->residentTileCount * TILE},
        {"resident_bytes_peak", "B", (double)s->resident_peak * TILE},
        {"tile_memory", "B", (double)d->tileMemorySize},
        {"device_memory", "B", (double)d->deviceMemorySize},
        {"bytes_read", "B", (double)d->bytesRead},
        {"bytes_uploaded", "B", (double)d->bytesUploaded},
        {"lod_bias", "levels", d->lodBias},
        {"time", "s", s->seconds},
        {"psnr", "dB", s->difference.psnr},
        {"ssim_mean", "", s->difference.ssim},
        {"flip_mean", "", s->difference.flip},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        print_figure(&figures[i], json);
}
