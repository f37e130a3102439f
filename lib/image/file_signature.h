/** The kinds of image files that Sluice reads itself, by their first bytes. */
#ifndef SLC_IMAGE_FILE_SIGNATURE_H
#define SLC_IMAGE_FILE_SIGNATURE_H

#include <string.h>

#define SLC_SIGNATURE_SIZE 12u

enum slc_file_signature {
    SLC_SIGNATURE_OTHER,
    SLC_SIGNATURE_STORE,
    SLC_SIGNATURE_EXR,
    SLC_SIGNATURE_DDS,
    SLC_SIGNATURE_KTX2,
    SLC_SIGNATURE_NEURAL,
    SLC_SIGNATURE_CATALOGUE ///< names stores
};

/** Returns the kind of a file. `bytes`: its first bytes, followed by zeros if it is shorter. */
static inline enum slc_file_signature slc_file_signature(const char bytes[SLC_SIGNATURE_SIZE])
{
    if (memcmp(bytes, "\x89SLS\r\n\x1A\n", 8) == 0)
        return SLC_SIGNATURE_STORE;
    if (memcmp(bytes, "\x76\x2F\x31\x01", 4) == 0)
        return SLC_SIGNATURE_EXR;
    if (memcmp(bytes, "DDS ", 4) == 0)
        return SLC_SIGNATURE_DDS;
    if (memcmp(bytes, "NTEX", 4) == 0)
        return SLC_SIGNATURE_NEURAL;
    if (memcmp(bytes, "sluice catal", 12) == 0)
        return SLC_SIGNATURE_CATALOGUE;
    return memcmp(bytes, "\xABKTX 20\xBB\r\n\x1A\n", 12) == 0 ? SLC_SIGNATURE_KTX2
                                                              : SLC_SIGNATURE_OTHER;
}

#endif /* SLC_IMAGE_FILE_SIGNATURE_H */
