/* A cold fill by a tile producer, against dispatches alone that write as many tiles. */
#include "fill.h"
#include "maker.h"

#include <stdio.h>

static bool produce_with(const struct bench *bench, struct maker *maker, const char *name,
                         uint32_t tiles_per_frame, double *best, uint64_t *tile_count)
{
    struct rig_info info = fill_info(bench, tiles_per_frame);
    const SluiceImageInfo image = {.structSize = sizeof image,
                                   .width = info.texture_size,
                                   .height = info.texture_size,
                                   .format = info.format,
                                   .pName = "made tiles"};
    const SluiceTileProducer producer = {.structSize = sizeof producer,
                                         .pImage = &image,
                                         .pUserData = maker,
                                         .pfnRecordTiles = maker_record_tiles};
    struct fill_times times;
    info.producer = &producer;
    if (!fill_best(&info, &times, tile_count))
        return false;
    double rate = (double)*tile_count / times.seconds;
    *best = rate > *best ? rate : *best;
    report(bench, rate, "tiles/s", "produce.%s.%u_per_frame.rate", name, tiles_per_frame);
    report(bench, (double)times.frames, "frames", "produce.%s.%u_per_frame.frames", name,
           tiles_per_frame);
    report(bench, 100 * times.host_seconds / times.seconds, "% of the time",
           "produce.%s.%u_per_frame.host", name, tiles_per_frame);
    if (!bench->wall)
        report(bench, 100 * times.gpu_seconds / times.seconds, "% of the time",
               "produce.%s.%u_per_frame.gpu", name, tiles_per_frame);
    return true;
}

static bool produce(const struct bench *bench, const char *name, uint32_t steps)
{
    static struct maker maker; /* large */
    bool done = maker_create(&maker, bench, steps);
    double best = 0, floor = 0;
    uint64_t tile_count = 0;
    for (uint32_t tiles = 256; done && tiles <= (options.quick ? 256u : 4096u); tiles *= 4)
        done = produce_with(bench, &maker, name, tiles, &best, &tile_count);
    done = done && maker_floor(&maker, (uint32_t)tile_count, &floor);
    maker_destroy(&maker);
    if (!done)
        return false;
    report(bench, best, "tiles/s", "produce.%s.rate", name);
    report(bench, floor, "tiles/s", "produce.%s.floor", name);
    report(bench, best / floor, "of the dispatch alone", "produce.%s.of_dispatch", name);
    return true;
}

bool measure_produce(const struct bench *bench)
{
    return produce(bench, "cheap", 0) && produce(bench, "dear", options.quick ? 15 : 255);
}
