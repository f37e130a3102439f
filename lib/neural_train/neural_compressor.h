/** Compressor: buffers and passes on a device. */
#ifndef SLC_NEURAL_TRAIN_COMPRESSOR_H
#define SLC_NEURAL_TRAIN_COMPRESSOR_H

#include "neural_train/train_plan.h"
#include "vulkan/buffer.h"
#include "vulkan/compute.h"

#define SLC_TRAIN_MAX_STEPS_PER_RECORD 1024u

/** Buffers, numbered like the shaders' bindings. */
enum slc_train_buffer {
    SLC_TRAIN_NETWORK,
    SLC_TRAIN_PARTIALS,
    SLC_TRAIN_LATENTS,
    SLC_TRAIN_STATE,
    SLC_TRAIN_GRADIENTS,
    SLC_TRAIN_REFERENCES,
    SLC_TRAIN_TABLE,
    SLC_TRAIN_LOSSES,
    SLC_TRAIN_BUFFER_COUNT
};

struct SluiceNeuralCompressor {
    SluiceVulkanContext *context;
    struct slc_train_plan plan;
    uint64_t fingerprint; ///< hash of plan and references
    struct slc_compute compute;
    struct slc_buffer buffers[SLC_TRAIN_BUFFER_COUNT]; ///< the last one is mapped
    struct slc_buffer upload;   ///< network, state, table, references; until they are copied
    struct slc_buffer readback; ///< network, state
    uint32_t tiles_per_group, group_count;
    uint32_t step;           ///< next step to record
    uint32_t recorded_count; ///< steps of the last recording
    uint32_t readback_step;
    uint16_t *texels; ///< trained_set.c; NULL before the first result
    char int8_blob[TRAIN_BIASES + 8 * TRAIN_ROWS];
    char fp8_blob[TRAIN_BIASES + 2 * (TRAIN_ROWS - TRAIN_OUTPUTS) + 8 * TRAIN_OUTPUTS];
    bool is_started;   ///< the copies from `upload` are recorded
    bool has_readback; ///< `readback` holds readback_step
};

/** Returns the bytes of master values and moments: the network's, and the latents'. */
uint64_t slc_train_network_size(void);
uint64_t slc_train_state_size(const struct slc_train_plan *plan);

/** Returns the last readback: latents in 0..1, and parameters of both networks. */
const float *slc_train_read_latents(const SluiceNeuralCompressor *compressor);
const float *slc_train_read_int8(const SluiceNeuralCompressor *compressor);
const float *slc_train_read_fp8(const SluiceNeuralCompressor *compressor);

/** trained_set.c */
void slc_train_free_result(SluiceNeuralCompressor *compressor);

/** train_checkpoint.c: writes network and state of a checkpoint. Errors, logged: CORRUPT_DATA. */
SluiceResult slc_train_restore(SluiceNeuralCompressor *compressor, const void *checkpoint,
                               size_t size, void *network_and_state);

#endif /* SLC_NEURAL_TRAIN_COMPRESSOR_H */
