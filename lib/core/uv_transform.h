/** Turns maps of a primary into maps of followers whose UVs are scaled and shifted. */
#ifndef SLC_CORE_UV_TRANSFORM_H
#define SLC_CORE_UV_TRANSFORM_H

#include "core/overlap.h"

#include <sluice/manager.h>

#include <stdbool.h>

/** Fixed point, so that all machines decide alike. */
#define SLC_UV_BITS 24

/** One axis: follower = primary * scale + offset, in units of 2^-24; then `wrap` applies. */
struct slc_uv_axis {
    int64_t scale, offset;
    SluiceUvWrap wrap;
};

struct slc_uv_transform {
    struct slc_uv_axis u, v;
};

/** Reads a transform. Returns NULL, or the reason why it is refused. */
const char *slc_uv_transform_read(struct slc_uv_transform *t, const SluiceUvTransform *from);
/** True if slc_uv_transform_read can have made the axis. */
bool slc_uv_axis_is_valid(const struct slc_uv_axis *axis);
/** True if the transform is the identity: follower and primary match cell by cell. */
bool slc_uv_transform_is_none(const struct slc_uv_transform *t);

/** The greatest d with w * |scale| >= W * 2^d in both axes; lower case is the follower. */
int slc_uv_level_offset(const struct slc_uv_transform *t, const SluiceStreamedTextureDesc *primary,
                        const SluiceStreamedTextureDesc *follower);

/**
 * Writes to each cell of `to` the least value of the cells of `from` that are sampled there.
 * `work` has from->rows * to->columns bytes.
 */
void slc_least_transformed(const struct slc_uv_transform *t, const struct slc_grid *from,
                           const uint8_t *values, const struct slc_grid *to, uint8_t *work,
                           uint8_t *least);

#endif /* SLC_CORE_UV_TRANSFORM_H */
