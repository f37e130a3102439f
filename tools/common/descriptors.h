/** File descriptors: as many as allowed, and some kept for what a program writes. */
#ifndef TOOLS_COMMON_DESCRIPTORS_H
#define TOOLS_COMMON_DESCRIPTORS_H

#define DESCRIPTORS_KEPT_MAX 240

/** Raises the soft limit of open files to the hard limit. Without success it stays. */
void descriptors_raise(void);

/** Descriptors that inputs cannot take. Zeroed keeps none. */
struct descriptors_kept {
    int numbers[DESCRIPTORS_KEPT_MAX];
    unsigned count;
};

/**
 * Keeps `count` descriptors until descriptors_release: before inputs are opened, for the outputs
 * that are opened afterwards. Fewer if that is more than a quarter of the limit.
 */
void descriptors_keep(struct descriptors_kept *kept, unsigned count);
void descriptors_release(struct descriptors_kept *kept);

#endif /* TOOLS_COMMON_DESCRIPTORS_H */
