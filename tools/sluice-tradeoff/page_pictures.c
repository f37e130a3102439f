#define _POSIX_C_SOURCE 200809L
#include "page_pictures.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "page_frames.h"
#include "page_json.h"
#include "page_shots.h"

#define SIDE_MAX 16384      /* pixels */
#define PICTURE_OVERHEAD 64 /* maximum bytes of JSON around a picture */
#define SET_OVERHEAD 512    /* maximum bytes around a set of them, with its role */
#define NOTHING INT32_C(-1)

struct picture {
    uint8_t *png; ///< owned
    size_t size;
    uint32_t width, height;
};

/* Pictures of one frame of a run. */
struct picture_set {
    uint32_t point, frame;
    const char *role, *metric;
    int32_t streamed, truth, flip; ///< indices in the pool, or NOTHING
};

struct album {
    struct picture *pool;
    struct picture_set *sets;
    uint32_t picture_count, set_count;
    size_t size_left;
    FILE *left_out; ///< JSON objects, in memory
    bool some_left_out;
};

static uint32_t read_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Reads only the size, because the browser decodes the picture and copes with errors in it. */
static bool parse_png(struct picture *picture)
{
    static const uint8_t signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                        0,    0,   0,   13,  'I',  'H',  'D',  'R'};
    if (picture->size < 33 || memcmp(picture->png, signature, sizeof signature) != 0)
        return false;
    picture->width = read_u32(picture->png + 16);
    picture->height = read_u32(picture->png + 20);
    return picture->width - 1 < SIDE_MAX && picture->height - 1 < SIDE_MAX;
}

static size_t size_on_page(size_t size)
{
    return (size + 2) / 3 * 4 + PICTURE_OVERHEAD;
}

static void leave_out(struct album *album, uint32_t point, uint32_t frame, const char *why)
{
    fprintf(album->left_out, "%s{\"point\":%" PRIu32 ",\"frame\":%" PRIu32 ",\"why\":",
            album->some_left_out ? ",\n" : "", point, frame);
    page_put_text(album->left_out, why);
    fputc('}', album->left_out);
    album->some_left_out = true;
}

/* Reads a picture to the end of the pool, which has room for it. */
static enum page_read read_picture(struct album *album, const char *folder, const char *kind,
                                   uint32_t frame, char why[PAGE_REASON_SIZE])
{
    struct picture *picture = &album->pool[album->picture_count];
    char name[32];
    memset(picture, 0, sizeof *picture);
    snprintf(name, sizeof name, "%s-%04" PRIu32 ".png", kind, frame);
    enum page_read read = page_read_file(folder, name, &picture->png, &picture->size, why);
    if (read == PAGE_READ && !parse_png(picture)) {
        snprintf(why, PAGE_REASON_SIZE, "%s is no PNG file", name);
        free(picture->png);
        picture->png = NULL;
        read = PAGE_LEFT_OUT;
    }
    return read;
}

/* Adds the picture read last to the pool, or frees it if the pool has an equal one. Returns the
 * index. */
static int32_t keep_picture(struct album *album)
{
    struct picture *picture = &album->pool[album->picture_count];
    for (uint32_t i = 0; i < album->picture_count; i++) {
        if (album->pool[i].size == picture->size &&
            memcmp(album->pool[i].png, picture->png, picture->size) == 0) {
            free(picture->png);
            picture->png = NULL;
            return (int32_t)i;
        }
    }
    return (int32_t)album->picture_count++;
}

/* Removes the pictures from index `picture_count` on. */
static void forget_pictures(struct album *album, uint32_t picture_count)
{
    while (album->picture_count > picture_count)
        free(album->pool[--album->picture_count].png);
}

static size_t size_since(const struct album *album, uint32_t first)
{
    size_t size = SET_OVERHEAD;
    for (uint32_t i = first; i < album->picture_count; i++)
        size += size_on_page(album->pool[i].size);
    return size;
}

/* Reads the pictures of a frame. Truth and difference may be missing, the frame itself must
 * exist. */
static enum page_read read_set(struct album *album, const char *folder, struct picture_set *set,
                               char why[PAGE_REASON_SIZE])
{
    static const char *const kinds[] = {"frame", "truth", "flip"};
    int32_t *const places[] = {&set->streamed, &set->truth, &set->flip};
    for (int i = 0; i < 3; i++) {
        char ignored[PAGE_REASON_SIZE];
        enum page_read read =
            read_picture(album, folder, kinds[i], set->frame, i == 0 ? why : ignored);
        if (read == PAGE_OUT_OF_MEMORY || (i == 0 && read == PAGE_LEFT_OUT))
            return read;
        *places[i] = read == PAGE_READ ? keep_picture(album) : NOTHING;
    }
    return PAGE_READ;
}

static bool add_set(struct album *album, const struct sweep *sweep,
                    const struct page_choice *choice, uint32_t frame)
{
    struct picture_set set = {choice->point, frame, choice->role, choice->metric, -1, -1, -1};
    char why[PAGE_REASON_SIZE];
    for (uint32_t i = 0; i < album->set_count; i++)
        if (album->sets[i].point == choice->point && album->sets[i].frame == frame)
            return true;
    uint32_t before = album->picture_count;
    enum page_read read = read_set(album, sweep->points[choice->point].folder, &set, why);
    if (read == PAGE_READ && size_since(album, before) > album->size_left) {
        snprintf(why, sizeof why, "the page has no room for it");
        read = PAGE_LEFT_OUT;
    }
    if (read == PAGE_READ) {
        album->size_left -= size_since(album, before);
        album->sets[album->set_count++] = set;
    } else {
        forget_pictures(album, before);
        leave_out(album, choice->point, frame, why);
    }
    return read != PAGE_OUT_OF_MEMORY;
}

static bool has_shot(const struct page_shots *shots, uint32_t frame)
{
    for (uint32_t i = 0; i < shots->count; i++)
        if (shots->frames[i] == frame)
            return true;
    return false;
}

/* Adds one frame of each run, so that all runs get equal room. */
static bool add_round(struct album *album, const struct sweep *sweep,
                      const struct page_choice *choices, uint32_t choice_count,
                      const struct page_shots *base, int round)
{
    for (uint32_t i = 0; i < choice_count; i++) {
        struct page_shots shots;
        if (!page_shots_get(&shots, sweep->points[choices[i].point].folder))
            return false;
        if (shots.count == 0) {
            if (round == 0)
                leave_out(album, choices[i].point, 0, "there are no pictures in its folder");
            continue;
        }
        const struct page_shots *from = round == 0 ? &shots : base;
        uint32_t frame = from->count > 0 ? from->frames[round == 2 ? from->count / 2 : 0] : 0;
        if (from->count > 0 && has_shot(&shots, frame) &&
            !add_set(album, sweep, &choices[i], frame))
            return false;
    }
    return true;
}

static bool fill_album(struct album *album, const struct sweep *sweep,
                       const struct page_choice *choices, uint32_t choice_count)
{
    struct page_shots base = {.count = 0};
    if (choice_count > 0 && !page_shots_get(&base, sweep->points[choices[0].point].folder))
        return false;
    for (int round = 0; round < PAGE_FRAMES_PER_RUN; round++)
        if (!add_round(album, sweep, choices, choice_count, &base, round))
            return false;
    return true;
}

static void put_base64(FILE *file, const uint8_t *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        uint32_t word = (uint32_t)bytes[i] << 16;
        word |= i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0;
        word |= i + 2 < size ? bytes[i + 2] : 0;
        fputc(digits[word >> 18], file);
        fputc(digits[word >> 12 & 63], file);
        fputc(i + 1 < size ? digits[word >> 6 & 63] : '=', file);
        fputc(i + 2 < size ? digits[word & 63] : '=', file);
    }
}

static void put_album(FILE *file, const struct album *album, const char *left_out)
{
    fputs("{\"sets\":[", file);
    for (uint32_t i = 0; i < album->set_count; i++) {
        const struct picture_set *set = &album->sets[i];
        fprintf(file, "%s{\"point\":%" PRIu32 ",\"frame\":%" PRIu32 ",\"streamed\":%" PRId32,
                i > 0 ? ",\n" : "", set->point, set->frame, set->streamed);
        fprintf(file, ",\"truth\":%" PRId32 ",\"flip\":%" PRId32 ",\"role\":", set->truth,
                set->flip);
        page_put_text(file, set->role);
        fputs(",\"metric\":", file);
        page_put_text(file, set->metric);
        fputc('}', file);
    }
    fprintf(file, "],\n\"left_out\":[%s],\n\"pool\":[", left_out);
    for (uint32_t i = 0; i < album->picture_count; i++) {
        const struct picture *picture = &album->pool[i];
        fprintf(file, "%s{\"width\":%" PRIu32 ",\"height\":%" PRIu32 ",\"png\":\"",
                i > 0 ? ",\n" : "", picture->width, picture->height);
        put_base64(file, picture->png, picture->size);
        fputs("\"}", file);
    }
    fputs("]}\n", file);
}

static void finish_album(struct album *album)
{
    forget_pictures(album, 0);
    free(album->pool);
    free(album->sets);
}

bool page_put_pictures(FILE *file, const struct sweep *sweep, const struct page_choice *choices,
                       uint32_t choice_count, size_t size_max)
{
    size_t sets = (size_t)choice_count * PAGE_FRAMES_PER_RUN + 1, size = 0;
    char *text = NULL;
    struct album album = {.size_left = size_max,
                          .sets = calloc(sets, sizeof *album.sets),
                          .pool = calloc(3 * sets, sizeof *album.pool),
                          .left_out = open_memstream(&text, &size)};
    bool enough_memory = album.sets && album.pool && album.left_out &&
                         fill_album(&album, sweep, choices, choice_count);
    if (album.left_out && fclose(album.left_out) != 0)
        enough_memory = false;
    if (enough_memory)
        put_album(file, &album, text);
    finish_album(&album);
    free(text);
    return enough_memory;
}
