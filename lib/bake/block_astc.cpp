#include "bake/block_astc.h"

#include <new>

#define ASTCENC_DYNAMIC_LIBRARY // names without C++ decoration, as the shared library has them
#include <astcenc.h>

extern "C" void *slc_astc_open(uint32_t extent, bool srgb, enum slc_astc_quality quality)
{
    static const float qualities[] = {ASTCENC_PRE_FAST, ASTCENC_PRE_MEDIUM, ASTCENC_PRE_THOROUGH};
    astcenc_config config;
    astcenc_context *context = nullptr;
    try {
        if (astcenc_config_init(srgb ? ASTCENC_PRF_LDR_SRGB : ASTCENC_PRF_LDR, extent, extent, 1,
                                qualities[quality], 0, &config) != ASTCENC_SUCCESS ||
            astcenc_context_alloc(&config, 1, &context) != ASTCENC_SUCCESS)
            return nullptr;
    } catch (const std::bad_alloc &) {
        return nullptr;
    }
    return context;
}

extern "C" void slc_astc_close(void *context)
{
    if (context)
        astcenc_context_free(static_cast<astcenc_context *>(context));
}

extern "C" bool slc_astc_compress(void *context, uint8_t *rgba, uint32_t width, uint32_t height,
                                  void *blocks, size_t size)
{
    static const astcenc_swizzle as_is = {ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B,
                                          ASTCENC_SWZ_A};
    astcenc_context *own = static_cast<astcenc_context *>(context);
    void *slice = rgba;
    astcenc_image image = {width, height, 1, ASTCENC_TYPE_U8, &slice};
    bool is_done = false;
    try {
        is_done = astcenc_compress_image(own, &image, &as_is, static_cast<uint8_t *>(blocks), size,
                                         0) == ASTCENC_SUCCESS;
    } catch (const std::bad_alloc &) {
    }
    return astcenc_compress_reset(own) == ASTCENC_SUCCESS && is_done;
}
