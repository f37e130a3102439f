/** Buffers as a streamer's shaders see them, filled by hand, for a few textures of a manager. */
#ifndef TESTS_SAMPLES_NEEDS_RIG_H
#define TESTS_SAMPLES_NEEDS_RIG_H

#include "streaming/needs.h"

#define NEEDS_RIG_TEXTURES 8

struct needs_rig {
    SluiceStreamedTextureManager *manager;
    uint32_t heap_count;
    SluiceStreamedTextureDesc descs[NEEDS_RIG_TEXTURES];
    SluiceTextureId ids[NEEDS_RIG_TEXTURES];
    struct needs_id needs_ids[NEEDS_RIG_TEXTURES];
    uint32_t count;
    struct SluiceTextureEntry table[NEEDS_RIG_TEXTURES];
    uint32_t *feedback, *min_mip; ///< all untouched, and nothing shown
    uint32_t word_count;
    struct needs_words words;
    struct needs needs;
};

void needs_rig_open(struct needs_rig *rig, const SluiceStreamedTextureDesc *descs, uint32_t count);
void needs_rig_close(struct needs_rig *rig);

/** Another manager with the same textures, of which nothing is wanted; the caller destroys it. */
SluiceStreamedTextureManager *needs_rig_manager(struct needs_rig *rig, SluiceTextureId *ids);

/** The words of a texture's regions. */
uint32_t *needs_rig_feedback(struct needs_rig *rig, uint32_t texture);
uint32_t *needs_rig_min_mip(struct needs_rig *rig, uint32_t texture);

struct needs_frame needs_rig_frame(struct needs_rig *rig);

#endif /* TESTS_SAMPLES_NEEDS_RIG_H */
