/** What becomes of a picture under given settings. */
#ifndef SLC_BAKE_PLAN_H
#define SLC_BAKE_PLAN_H

#include <sluice/store.h>

#include "bake/picture.h"
#include "image/format_size.h"

struct slc_plan {
    SluiceBakeSettings settings;
    struct slc_rules rules;
    SluiceFormat format; ///< stored; rules.format is that of texels before they become blocks
    SluiceStoreColorSpace color_space;
    SluiceStoreMeaning meaning;
    uint32_t level_count;
    bool reaches_around; ///< rows of a level may begin in its middle
    float threshold;     ///< that alpha has to reach before it is rounded; 0: no cut-out
};

/** Errors, logged: INVALID_ARGUMENT for values out of their ranges. */
SluiceResult slc_check_settings(const SluiceBakeSettings *settings, const SluiceLogCallback *log);

/** Errors: UNSUPPORTED for formats that cannot be made, logged. `decoded16` may be NULL. */
SluiceResult slc_plan_make(const struct slc_picture *picture, const SluiceBakeSettings *settings,
                           const float *decoded16, struct slc_plan *plan);

#endif /* SLC_BAKE_PLAN_H */
