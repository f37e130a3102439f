#include "bake/astc_back.h"

#define ASTCENC_DYNAMIC_LIBRARY // names without C++ decoration, as the shared library has them
#include <astcenc.h>

extern "C" bool astc_back(uint32_t extent, const uint8_t *blocks, size_t size, uint32_t width,
                          uint32_t height, uint8_t *rgba)
{
    static const astcenc_swizzle as_is = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B,
                                          ASTCENC_SWZ_A};
    astcenc_config config;
    astcenc_context *context = nullptr;
    void *slice = rgba;
    astcenc_image image = {width, height, 1, ASTCENC_TYPE_U8, &slice};
    if (astcenc_config_init(ASTCENC_PRF_LDR, extent, extent, 1, ASTCENC_PRE_FAST,
                            ASTCENC_FLG_DECOMPRESS_ONLY, &config) != ASTCENC_SUCCESS ||
        astcenc_context_alloc(&config, 1, &context) != ASTCENC_SUCCESS)
        return false;
    bool is_done =
        astcenc_decompress_image(context, blocks, size, &image, &as_is, 0) == ASTCENC_SUCCESS;
    astcenc_context_free(context);
    return is_done;
}
