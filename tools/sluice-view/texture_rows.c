#include "texture_rows.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

struct texture_row texture_row_of(const struct stage *stage, const struct view_facts *facts,
                                  uint32_t index)
{
    const struct stage_texture *t = stage_texture(stage, index);
    const struct facts_texture *f = &facts->textures[index];
    const SluiceTextureStatistics *s = &f->statistics;
    return (struct texture_row){
        .texture = index,
        .name = t->name,
        .format = t->format,
        .set = t->primary == STAGE_NO_TEXTURE ? "" : stage_texture(stage, t->primary)->name,
        .source = t->path,
        .width = t->width,
        .height = t->height,
        .level_count = t->level_count,
        .resident = s->residentTileCount,
        .wanted = s->wantedTileCount,
        .all = t->size / SLUICE_DEFAULT_TILE_SIZE,
        .size = s->residentSize,
        .finest_level = f->finest_level,
        .seen_seconds =
            s->seen ? (double)(stage_now(stage) - s->seenTime) / STAGE_TICKS_PER_SECOND : -1.0,
        .loads = s->mappedTotal,
        .evictions = s->unmappedTotal,
        .failures = s->failedTotal,
        .thrash = f->thrash};
}

struct texture_row texture_rows_sum(const struct texture_row *rows, uint32_t count)
{
    struct texture_row sum = {.texture = STAGE_NO_TEXTURE,
                              .name = "",
                              .format = "",
                              .set = "",
                              .source = "",
                              .finest_level = SLUICE_MIP_UNTOUCHED,
                              .seen_seconds = -1.0};
    for (uint32_t i = 0; i < count; i++) {
        const struct texture_row *r = &rows[i];
        sum.resident += r->resident;
        sum.wanted += r->wanted;
        sum.all += r->all;
        sum.size += r->size;
        sum.loads += r->loads;
        sum.evictions += r->evictions;
        sum.failures += r->failures;
        if (r->finest_level < sum.finest_level)
            sum.finest_level = r->finest_level;
        if (r->seen_seconds >= 0 && (sum.seen_seconds < 0 || r->seen_seconds < sum.seen_seconds))
            sum.seen_seconds = r->seen_seconds;
    }
    sum.thrash = sum.resident > 0 ? (double)sum.loads / (double)sum.resident : 0.0;
    return sum;
}

static bool has_word(const char *text, const char *word, size_t length)
{
    for (; *text; text++) {
        size_t i = 0;
        while (i < length && text[i] &&
               tolower((unsigned char)text[i]) == tolower((unsigned char)word[i]))
            i++;
        if (i == length)
            return true;
    }
    return false;
}

bool texture_row_matches(const struct texture_row *row, const char *filter)
{
    for (size_t length; *(filter += strspn(filter, " ")); filter += length) {
        length = strcspn(filter, " ");
        if (!has_word(row->name, filter, length) && !has_word(row->format, filter, length) &&
            !has_word(row->set, filter, length) && !has_word(row->source, filter, length))
            return false;
    }
    return true;
}

static double key_of(const struct texture_row *r, enum texture_column column)
{
    switch (column) {
    case COLUMN_SIZE: return (double)r->width * r->height;
    case COLUMN_LEVELS: return r->level_count;
    case COLUMN_RESIDENT: return (double)r->resident;
    case COLUMN_WANTED: return (double)r->wanted;
    case COLUMN_ALL: return (double)r->all;
    case COLUMN_MEMORY: return (double)r->size;
    case COLUMN_FINEST: return r->finest_level;
    case COLUMN_SEEN: return r->seen_seconds >= 0 ? r->seen_seconds : 1e300;
    case COLUMN_LOADS: return (double)r->loads;
    case COLUMN_THRASH: return r->thrash;
    case COLUMN_EVICTED: return (double)r->evictions;
    case COLUMN_FAILED: return (double)r->failures;
    default: return 0;
    }
}

/* A row with the text of the sorted column, which is compared before the name. */
struct ordered {
    const char *text;
    struct texture_row row;
};

static int compare_up(const void *left, const void *right)
{
    const struct ordered *a = left, *b = right;
    if (a->row.key != b->row.key)
        return a->row.key < b->row.key ? -1 : 1;
    int order = strcmp(a->text, b->text);
    if (order == 0)
        order = strcmp(a->row.name, b->row.name);
    return order ? order : a->row.texture < b->row.texture ? -1 : 1;
}

static int compare_down(const void *left, const void *right)
{
    return compare_up(right, left);
}

static const char *text_of(const struct texture_row *row, enum texture_column column)
{
    return column == COLUMN_FORMAT   ? row->format
           : column == COLUMN_SET    ? row->set
           : column == COLUMN_SOURCE ? row->source
                                     : row->name;
}

/* Keeps the order without memory. */
void texture_rows_sort(struct texture_row *rows, uint32_t count, enum texture_column column,
                       bool descending)
{
    struct ordered *ordered = malloc((count + 1u) * sizeof *ordered);
    for (uint32_t i = 0; ordered && i < count; i++) {
        ordered[i] = (struct ordered){text_of(&rows[i], column), rows[i]};
        ordered[i].row.key = key_of(&rows[i], column);
    }
    if (ordered)
        qsort(ordered, count, sizeof *ordered, descending ? compare_down : compare_up);
    for (uint32_t i = 0; ordered && i < count; i++)
        rows[i] = ordered[i].row;
    free(ordered);
}

/* Writes a text in quotes, and doubles quotes within the text. */
static void write_text(FILE *file, const char *text)
{
    putc('"', file);
    for (; *text; text++) {
        if (*text == '"')
            putc('"', file);
        putc(*text, file);
    }
    putc('"', file);
}

bool texture_rows_write(FILE *file, const struct texture_row *rows, uint32_t count)
{
    fprintf(file, "name,width,height,format,levels,resident_tiles,wanted_tiles,all_tiles,"
                  "resident_bytes,finest_level,seconds_since_seen,loads,loads_per_tile,evictions,"
                  "failures,set,source\n");
    for (uint32_t i = 0; i < count; i++) {
        const struct texture_row *r = &rows[i];
        write_text(file, r->name);
        fprintf(file, ",%u,%u,%s,%u,%llu,%llu,%llu,%llu,%u,", r->width, r->height, r->format,
                r->level_count, (unsigned long long)r->resident, (unsigned long long)r->wanted,
                (unsigned long long)r->all, (unsigned long long)r->size, r->finest_level);
        if (r->seen_seconds >= 0)
            fprintf(file, "%.3f", r->seen_seconds);
        fprintf(file, ",%llu,%.3f,%llu,%llu,", (unsigned long long)r->loads, r->thrash,
                (unsigned long long)r->evictions, (unsigned long long)r->failures);
        write_text(file, r->set);
        putc(',', file);
        write_text(file, r->source);
        putc('\n', file);
    }
    return !ferror(file);
}
