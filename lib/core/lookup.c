#include "core/lookup.h"

#include "core/refusal.h"

SluiceResult slc_find_texture(const slc_manager *m, SluiceTextureId id,
                              struct slc_managed_texture **out)
{
    uint32_t index = (uint32_t)id, generation = (uint32_t)(id >> 32);
    if (index >= m->texture_end || generation == 0)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    struct slc_managed_texture *t = slc_texture_at(m, index);
    if (generation > t->generation)
        return SLUICE_ERROR_UNKNOWN_TEXTURE;
    if (generation < t->generation || !t->live)
        return SLUICE_ERROR_STALE_TEXTURE;
    *out = t;
    return SLUICE_SUCCESS;
}

SluiceResult slc_find_scope(const slc_manager *m, const char *function, SluiceTextureId id,
                            struct slc_managed_texture **out)
{
    *out = NULL;
    if (id == SLUICE_ALL_TEXTURES)
        return SLUICE_SUCCESS;
    if (id == SLUICE_NO_TEXTURE)
        return slc_refuse(m, function,
                          "textureId is SLUICE_NO_TEXTURE; for all textures it is "
                          "SLUICE_ALL_TEXTURES");
    return slc_find_texture(m, id, out);
}
