/** Accessors of a glTF file. */
#ifndef SLUICE_VIEW_GLTF_ACCESSOR_H
#define SLUICE_VIEW_GLTF_ACCESSOR_H

#include "gltf_file.h"

struct gltf_accessor {
    uint64_t count, component_type, offset, stride, element;
    uint32_t view, components; ///< `view` GLTF_NONE: all elements are zero
    bool sparse, normalized;
};

/** Reads and checks the members of an accessor. False, with `error` set, on failure. */
bool gltf_read_accessor(struct gltf_file *file, uint32_t index, struct gltf_accessor *accessor);
/** Returns the numbers of all elements of a checked accessor, sparse elements included. Normalized
 *  whole numbers become -1 to 1. NULL without memory. */
double *gltf_read_numbers(const struct gltf_file *file, uint32_t index,
                          const struct gltf_accessor *accessor);
/** Checks that samplers fit their channels and times ascend, as part of gltf_check. */
bool gltf_check_animation(struct gltf_file *file, uint32_t index);

#endif /* SLUICE_VIEW_GLTF_ACCESSOR_H */
