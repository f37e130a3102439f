#define _POSIX_C_SOURCE 200809L
#include "page_shots.h"

#include <dirent.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "page_frames.h"

struct shot {
    uint32_t frame;
    double badness; ///< more is worse
};

static int compare_shots(const void *a, const void *b)
{
    const struct shot *left = a, *right = b;
    bool left_known = !isnan(left->badness), right_known = !isnan(right->badness);
    if (left_known != right_known)
        return left_known ? -1 : 1;
    if (left_known && left->badness != right->badness)
        return left->badness > right->badness ? -1 : 1;
    return left->frame < right->frame ? -1 : left->frame > right->frame;
}

/* Parses "frame-0012.png". Returns false for other names. */
static bool parse_name(const char *name, uint32_t *frame)
{
    int end = 0;
    return sscanf(name, "frame-%9" SCNu32 ".png%n", frame, &end) == 1 && end > 0 &&
           name[end] == '\0' && name[6] >= '0' && name[6] <= '9';
}

static uint32_t find_shots(struct shot *found, const char *folder)
{
    uint32_t count = 0;
    DIR *entries = opendir(folder);
    if (!entries)
        return 0;
    for (struct dirent *entry; (entry = readdir(entries)) && count < PAGE_SHOTS_MAX;)
        if (parse_name(entry->d_name, &found[count].frame))
            found[count++].badness = NAN;
    closedir(entries);
    return count;
}

static bool rate_shots(struct shot *found, uint32_t count, const struct page_frames *frames,
                       const char *name, double sign)
{
    bool all_known = true;
    int column = page_frames_find(frames, name);
    for (uint32_t i = 0; i < count; i++) {
        found[i].badness = sign * page_frames_get(frames, found[i].frame, column);
        all_known = all_known && !isnan(found[i].badness);
    }
    return all_known;
}

bool page_shots_get(struct page_shots *shots, const char *folder)
{
    struct shot found[PAGE_SHOTS_MAX];
    struct page_frames frames;
    char reason[PAGE_REASON_SIZE];
    shots->count = find_shots(found, folder);
    enum page_read read = page_frames_init(&frames, folder, reason);
    if (read == PAGE_OUT_OF_MEMORY)
        return false;
    if (read == PAGE_READ)
        (void)(rate_shots(found, shots->count, &frames, "flip", 1.0) ||
               rate_shots(found, shots->count, &frames, "psnr_db", -1.0));
    page_frames_finish(&frames);
    qsort(found, shots->count, sizeof *found, compare_shots);
    for (uint32_t i = 0; i < shots->count; i++)
        shots->frames[i] = found[i].frame;
    return true;
}
