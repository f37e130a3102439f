/* Checkpoint: header, network, and latents' state, for the same device and version only. */
#include "neural_train/neural_compressor.h"

#include "base/log.h"
#include "neural_train/train_schedule.h"
#include "vulkan/context.h"

#include <math.h>
#include <string.h>

#define MAGIC UINT64_C(0x33304B4854434C53) /* SLCTHK03 */

struct header {
    uint64_t magic, fingerprint, checksum;
    uint32_t step, reserved;
};

/* FNV-1a over words. */
static uint64_t checksum_of(const char *bytes, size_t size, uint64_t hash)
{
    for (size_t i = 0; i + 4 <= size; i += 4) {
        uint32_t word;
        memcpy(&word, bytes + i, 4);
        hash = (hash ^ word) * UINT64_C(0x100000001B3);
    }
    return hash;
}

static size_t state_size(const SluiceNeuralCompressor *c)
{
    return (size_t)(slc_train_network_size() + slc_train_state_size(&c->plan));
}

SluiceResult sluiceGetNeuralCheckpoint(const SluiceNeuralCompressor *compressor, void *pCheckpoint,
                                       size_t *pSize)
{
    const SluiceNeuralCompressor *c = compressor;
    if (!c || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    const size_t size = sizeof(struct header) + state_size(c);
    if (!pCheckpoint) {
        *pSize = size;
        return SLUICE_SUCCESS;
    }
    if (!c->has_readback)
        return slc_log_refusal(&c->context->vk.log, "sluiceGetNeuralCheckpoint: no readback yet");
    if (*pSize != size)
        return SLUICE_ERROR_SIZE_MISMATCH;
    struct header header = {
        .magic = MAGIC, .fingerprint = c->fingerprint, .step = c->readback_step};
    memcpy((char *)pCheckpoint + sizeof header, c->readback.mapped, state_size(c));
    header.checksum = checksum_of((char *)pCheckpoint + sizeof header, state_size(c), header.step);
    memcpy(pCheckpoint, &header, sizeof header);
    return SLUICE_SUCCESS;
}

static SluiceResult refuse(const SluiceNeuralCompressor *c, const char *why)
{
    slc_log(&c->context->vk.log, SLUICE_LOG_ERROR, "checkpoint: %s", why);
    return SLUICE_ERROR_CORRUPT_DATA;
}

SluiceResult slc_train_restore(SluiceNeuralCompressor *compressor, const void *checkpoint,
                               size_t size, void *network_and_state)
{
    SluiceNeuralCompressor *c = compressor;
    struct header header;
    if (size != sizeof header + state_size(c))
        return refuse(c, "its size is that of other settings");
    memcpy(&header, checkpoint, sizeof header);
    const char *state = (const char *)checkpoint + sizeof header;
    if (header.magic != MAGIC || header.reserved != 0)
        return refuse(c, "is none, or of another version");
    if (header.fingerprint != c->fingerprint)
        return refuse(c, "is of other settings or other pictures");
    if (header.step > slc_train_total_steps(&c->plan) ||
        header.checksum != checksum_of(state, state_size(c), header.step))
        return refuse(c, "is damaged");
    memcpy(network_and_state, state, state_size(c));
    c->step = header.step;
    return SLUICE_SUCCESS;
}
