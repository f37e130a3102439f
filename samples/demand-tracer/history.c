#include "history.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../tools/common/output_file.h"

bool history_add(struct history *h, const struct history_row *row)
{
    if (h->count == h->room) {
        const size_t room = h->room ? 2 * h->room : 64;
        struct history_row *rows = realloc(h->rows, room * sizeof *rows);
        if (!rows) {
            fprintf(stderr, "out of memory\n");
            return false;
        }
        h->rows = rows;
        h->room = room;
    }
    h->rows[h->count++] = *row;
    if (row->resident_tiles > h->resident_peak)
        h->resident_peak = row->resident_tiles;
    return true;
}

void history_finish(struct history *h)
{
    free(h->rows);
    *h = (struct history){0};
}

static void write_row(FILE *file, const struct history_row *row)
{
    const struct launch_record *l = &row->launch;
    fprintf(file, "%u,%u,%u,%u,%u,%u,%llu,%llu,%llu,%llu,%.3f,%.6f,%u\n", l->index, l->sample,
            l->traced_count, l->missing_count, l->requests.missingCount, l->requests.servedCount,
            (unsigned long long)row->loaded_tiles, (unsigned long long)row->resident_tiles,
            (unsigned long long)row->bytes_read, (unsigned long long)row->bytes_uploaded,
            (double)l->requests.lodBias, row->seconds, row->device);
}

bool history_write(const struct history *const *histories, uint32_t count, const char *folder)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/frames.csv", folder);
    struct output_file *output = output_file_begin(path);
    FILE *file = output ? output_file_stream(output) : NULL;
    if (file)
        fputs("frame,sample,traced_pixels,missing_pixels,missing_pages,served_pages,loaded_tiles,"
              "resident_tiles,bytes_read,bytes_uploaded,lod_bias,seconds,device\n",
              file);
    for (uint32_t i = 0; file && i < count; i++)
        for (size_t row = 0; row < histories[i]->count; row++)
            write_row(file, &histories[i]->rows[row]);
    return output_file_end(output, true);
}
