/** Compresses a set on a device, writes the file and compares what it decodes to. */
#ifndef TOOLS_COMMON_TRAINING_RUN_H
#define TOOLS_COMMON_TRAINING_RUN_H

#include "gpu.h"
#include "training_set.h"

struct training_run {
    const struct gpu *gpu;
    const struct training_set *set;
    uint32_t scale, features; ///< texels of mip 0 per latent texel in a direction, features of it
    uint32_t steps, batch, seed;
    const char *output;     ///< .ntc file
    const char *checkpoint; ///< read if it is there, written now and then; NULL: none
    bool progress;          ///< lines on stderr
    /* Results. */
    uint32_t steps_run;    ///< of both networks, by this run
    double seconds;        ///< of training alone
    double psnr, fp8_psnr; ///< dB of mip 0, decoded from the file by the C decoder
    double channel_psnr[SLUICE_NEURAL_MAX_CHANNELS]; ///< of the int8 network
    uint64_t repaired;     ///< texels of masks in all mips that training left inexact
    double repair_seconds; ///< of one processor
    double exact_mask;     ///< share of 0s and 1s of masks in all mips that are so exactly, int8; 1
                           ///< without a mask
    uint64_t file_size;    ///< bytes
};

/** False, which stderr says. */
bool training_run(struct training_run *run);

#endif /* TOOLS_COMMON_TRAINING_RUN_H */
