#include "bake/squish_back.h"

#include <cstring>

#include <squish.h>

// libsquish writes BC4 and BC5, but reads neither; each is made of the alpha blocks of BC3, which
// it reads.
static void alpha_back(const unsigned char *block, unsigned char *channel)
{
    unsigned char both[16] = {0}, rgba[64];
    std::memcpy(both, block, 8);
    squish::Decompress(rgba, both, squish::kDxt5);
    for (int i = 0; i < 16; i++)
        channel[4 * i] = rgba[4 * i + 3];
}

extern "C" void squish_back(int kind, const void *block, unsigned char rgba[64])
{
    const unsigned char *bytes = static_cast<const unsigned char *>(block);
    if (kind < 2) {
        squish::Decompress(rgba, block, kind == 0 ? squish::kDxt1 : squish::kDxt5);
        return;
    }
    std::memset(rgba, 0, 64);
    alpha_back(bytes, rgba);
    if (kind == 3)
        alpha_back(bytes + 8, rgba + 1);
}
