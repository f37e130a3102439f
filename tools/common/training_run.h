/** Compresses a set on a device, writes the file, and measures the decoded texels. */
#ifndef TOOLS_COMMON_TRAINING_RUN_H
#define TOOLS_COMMON_TRAINING_RUN_H

#include "gpu.h"
#include "training_set.h"

struct training_run {
    const struct gpu *gpu;
    const struct training_set *set;
    uint32_t scale, features; ///< `scale`: texels of mip 0 per latent texel and axis; `features`:
                              ///< features per latent texel
    uint32_t steps, batch, seed;
    const char *output;     ///< .ntc file
    const char *checkpoint; ///< read if it exists, written now and then; NULL: none
    bool progress;          ///< print progress on stderr
    /* Results. */
    uint32_t steps_run;    ///< training steps of both networks in this run
    double seconds;        ///< time of training alone
    double psnr, fp8_psnr; ///< dB of mip 0, decoded from the file by the C decoder
    double channel_psnr[SLUICE_NEURAL_MAX_CHANNELS]; ///< PSNR of the int8 network by channel
    uint64_t repaired;     ///< mask texels in all mips that training left inexact
    double repair_seconds; ///< processor time of repair
    double exact_mask; ///< share of masks' 0s and 1s that are exact, in all mips, int8; 1 without a
                       ///< mask
    uint64_t file_size; ///< bytes
};

/** Returns false on error, and reports it on stderr. */
bool training_run(struct training_run *run);

#endif /* TOOLS_COMMON_TRAINING_RUN_H */
