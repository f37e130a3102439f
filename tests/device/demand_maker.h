/** A demand texture written by a compute shader, and its counterpart on the host. */
#ifndef TESTS_DEVICE_DEMAND_MAKER_H
#define TESTS_DEVICE_DEMAND_MAKER_H

#include "device/demand_runner.h"
#include "device/maker.h"

struct demand_maker {
    struct maker maker;
    struct runner *r;
    SluiceImageInfo info;
    SluiceDemandTextureId id;
    uint32_t timeout;      ///< launches; set it before demand_maker_add
    uint32_t answer_level; ///< level whose tiles get `answer`; UINT32_MAX: none
    SluiceResult answer;
    bool removes;        ///< true: the callback removes the texture
    uint32_t made_count; ///< recorded tiles and levels of mip tails
    uint32_t asked_count;
};

/** Call before filling in `info` and the answers. */
void demand_maker_init(struct demand_maker *m, struct runner *r, uint32_t width, uint32_t height);
void demand_maker_finish(struct demand_maker *m);
/** Adds the texture. */
void demand_maker_add(struct demand_maker *m);
/** Samples texels of all levels, `step` apart. The last level has the color of its only texel. */
void demand_maker_sample(struct demand_maker *m, uint32_t step);
void demand_maker_add_texel(struct demand_maker *m, uint32_t level, uint32_t x, uint32_t y);
/** Returns whether the output equals the texel's bytes in that version. */
bool demand_maker_shows(const struct demand_maker *m, uint32_t sample, uint32_t version,
                        uint32_t level, uint32_t x, uint32_t y);
/** Checks that the samples of demand_maker_sample are resident and equal the host's texels bit by
 * bit. */
void demand_maker_check(const struct demand_maker *m, uint32_t step);

#endif /* TESTS_DEVICE_DEMAND_MAKER_H */
