#include "open/opener.h"

#include "base/alloc.h"
#include "base/log.h"
#include "platform/time_now.h"

#include <string.h>

#define MAX_AGE ((uint64_t)1000000000) /* nanoseconds between two checks at a server */

static struct slc_catalogue_place place_of(const struct slc_opened_image *image)
{
    const SluiceImageOpener *opener = image->opener;
    return (struct slc_catalogue_place){.path = image->path,
                                        .shown = image->shown ? image->shown : image->path,
                                        .input = image->shown ? &image->input : NULL,
                                        .pool = opener->files.pool,
                                        .allocator = &opener->allocator,
                                        .log = &opener->log};
}

SluiceResult slc_opener_read_catalogue(struct slc_opened_image *image)
{
    const struct slc_catalogue_place place = place_of(image);
    return slc_catalogue_read(&place, &image->catalogue);
}

struct slc_opened_image *slc_opener_keep(struct slc_opened_image *image)
{
    struct slc_opened_image **kept = image->opener->kept, *dropped;
    uint32_t i = 0;
    while (i < SLC_OPENER_CATALOGUES - 1 && kept[i] && strcmp(kept[i]->path, image->path) != 0)
        i++;
    dropped = kept[i];
    memmove(kept + 1, kept, i * sizeof(struct slc_opened_image *));
    kept[0] = image;
    image->reference_count++;
    return dropped;
}

/* Moves a catalogue to the front of the kept list. The mutex is held. */
static void keep_longest(const struct slc_opened_image *image)
{
    struct slc_opened_image **kept = image->opener->kept, *moved;
    uint32_t i = 0;
    while (i < SLC_OPENER_CATALOGUES && kept[i] != image)
        i++;
    if (i == SLC_OPENER_CATALOGUES)
        return;
    moved = kept[i];
    memmove(kept + 1, kept, i * sizeof(struct slc_opened_image *));
    kept[0] = moved;
}

/* Removes an outdated catalogue from bucket and kept list. False: not kept. The mutex is held. */
static bool let_go(struct slc_opened_image *image)
{
    struct slc_opened_image **kept = image->opener->kept;
    uint32_t i = 0;
    slc_opener_forget(image);
    while (i < SLC_OPENER_CATALOGUES && kept[i] != image)
        i++;
    if (i == SLC_OPENER_CATALOGUES)
        return false;
    for (; i < SLC_OPENER_CATALOGUES - 1; i++)
        kept[i] = kept[i + 1];
    kept[i] = NULL;
    return true;
}

/* Begins a check. During a check, threads without doubt use the catalogue. The mutex is held. */
static bool begin_check(struct slc_opened_image *image, uint64_t began, bool is_in_doubt)
{
    const uint64_t age = slc_monotonic_time() - image->checked;
    if (image->checked >= began || (!is_in_doubt && (image->is_checking || age <= MAX_AGE)))
        return false;
    image->is_checking = true;
    return true;
}

/* Asks the server. If the check gives no answer, a catalogue in doubt counts as changed. */
static bool is_unchanged(const struct slc_opened_image *image, bool is_in_doubt)
{
    const SluiceImageOpener *opener = image->opener;
    SluiceResult result = SLUICE_ERROR_UNSUPPORTED;
    if (opener->check_path)
        result = opener->check_path(opener->path_opener.pUserData, image->opened);
    return result == SLUICE_SUCCESS || (result == SLUICE_ERROR_UNSUPPORTED && !is_in_doubt);
}

bool slc_opener_is_current(struct slc_opened_image *image, uint64_t began, bool *is_sure)
{
    SluiceImageOpener *opener = image->opener;
    slc_mutex_lock(&opener->mutex);
    keep_longest(image);
    if (!image->shown) { /* the identity of files was compared */
        slc_mutex_unlock(&opener->mutex);
        return true;
    }
    bool is_due = (opener->check_path || *is_sure) && begin_check(image, began, *is_sure);
    const uint64_t now = slc_monotonic_time();
    slc_mutex_unlock(&opener->mutex);
    bool is_current = !is_due || is_unchanged(image, *is_sure), was_kept = false;
    slc_mutex_lock(&opener->mutex);
    if (is_due)
        image->is_checking = false;
    if (is_due && is_current && image->checked < now)
        image->checked = now;
    *is_sure = image->checked >= began;
    if (!is_current)
        was_kept = let_go(image);
    slc_mutex_unlock(&opener->mutex);
    if (was_kept)
        slc_opener_release(image);
    return is_current;
}

static bool is_named_store(const struct slc_opened_image *image, uint64_t hash)
{
#ifdef SLC_HAVE_STORE
    uint64_t found;
    return image->kind == SLUICE_IMAGE_FILE_KIND_STORE &&
           sluiceHashStore(image->source, &found) == SLUICE_SUCCESS && found == hash;
#else
    (void)image, (void)hash;
    return false;
#endif
}

/* Opens a store and checks its hash. Errors: CORRUPT_DATA for another store. */
static SluiceResult open_entry(SluiceImageOpener *opener, const struct slc_catalogue_entry *entry,
                               const SluiceLogCallback *log, SluiceImageSource **source)
{
    struct slc_open_request request = {.path = entry->store, .is_entry = true};
    SluiceImageSource *store = NULL;
    SluiceResult result = slc_opener_open(opener, &request, &store);
    if (result != SLUICE_SUCCESS)
        return result;
    if (is_named_store((const struct slc_opened_image *)store, entry->hash)) {
        *source = store;
        return SLUICE_SUCCESS;
    }
    const char *shown = ((const struct slc_opened_image *)store)->shown;
    slc_log(log, SLUICE_LOG_ERROR, "%s: is not the store that the catalogue names",
            shown ? shown : entry->store);
    sluiceDestroyImageSource(store);
    return SLUICE_ERROR_CORRUPT_DATA;
}

SluiceResult slc_opener_open_row(struct slc_opened_image *by, const struct slc_open_request *r,
                                 bool is_sure, SluiceImageSource **source)
{
    SluiceImageOpener *opener = by->opener;
    struct slc_catalogue_place place = place_of(by);
    struct slc_catalogue_entry entry = {0};
    place.log = is_sure ? place.log : NULL;
    if (r->is_entry) /* catalogues cannot contain catalogues */
        return SLUICE_ERROR_CORRUPT_DATA;
    SluiceResult result = slc_catalogue_find(by->catalogue, &place, r->texture, &entry);
    if (result == SLUICE_SUCCESS)
        result = open_entry(opener, &entry, place.log, source);
    slc_catalogue_entry_finish(&entry, &opener->allocator);
    return result;
}
