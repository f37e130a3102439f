/** Plan of a bake: format, filter and rules for a picture under given settings. */
#ifndef SLC_BAKE_PLAN_H
#define SLC_BAKE_PLAN_H

#include <sluice/store.h>

#include "bake/picture.h"
#include "image/format_size.h"

struct slc_plan {
    SluiceBakeSettings settings;
    struct slc_rules rules;
    SluiceFormat format; ///< in the store; rules.format: texels before block encoding
    SluiceStoreColorSpace color_space;
    SluiceStoreMeaning meaning;
    uint32_t level_count;
    bool reaches_around; ///< the first row of a level may not be row 0
    float threshold;     ///< least alpha before rounding that is opaque; 0: no cut-out
};

/** Checks the ranges of settings. Errors, logged: INVALID_ARGUMENT. */
SluiceResult slc_check_settings(const SluiceBakeSettings *settings, const SluiceLogCallback *log);

/** Makes a plan. Errors, logged: UNSUPPORTED formats. `decoded16` may be NULL. */
SluiceResult slc_plan_make(const struct slc_picture *picture, const SluiceBakeSettings *settings,
                           const float *decoded16, struct slc_plan *plan);

#endif /* SLC_BAKE_PLAN_H */
