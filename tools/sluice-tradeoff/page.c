#include "page.h"

#include <stdlib.h>
#include <string.h>

#include "../common/output_file.h"
#include "page_choose.h"
#include "page_json.h"
#include "page_pictures.h"
#include "page_series.h"
#include "page_template.h"
#include "../common/text.h"

/* Bytes: a quarter of the page. Pictures have the rest. */
#define SERIES_SIZE_MAX ((size_t)3 << 19)

struct page {
    FILE *file;
    const struct sweep *sweep;
    const struct sweep_recommendation *recommendations;
    uint32_t recommendation_count;
    struct page_choice *choices; ///< owned
    uint32_t choice_count, prominent_count;
    size_t template_left; ///< bytes of the template that are not written yet
};

static size_t room_left(const struct page *page)
{
    long written = ftell(page->file);
    size_t used = (written < 0 ? PAGE_SIZE_MAX : (size_t)written) + page->template_left;
    used += 4096; /* brackets, and reasons for parts that are left out */
    return used < PAGE_SIZE_MAX ? PAGE_SIZE_MAX - used : 0;
}

static bool put_part(struct page *page, enum page_template_part part)
{
    size_t room = room_left(page);
    switch (part) {
    case PAGE_TEMPLATE_SWEEP:
        page_put_sweep(page->file, page->sweep, page->recommendations, page->recommendation_count);
        return true;
    case PAGE_TEMPLATE_SERIES:
        return page_put_series(page->file, page->sweep, page->choices, page->choice_count,
                               room < SERIES_SIZE_MAX ? room : SERIES_SIZE_MAX);
    case PAGE_TEMPLATE_PICTURES:
        return page_put_pictures(page->file, page->sweep, page->choices, page->prominent_count,
                                 room);
    }
    return true;
}

/* Writes the pieces of the template, with a part after each. */
static bool put_page(struct page *page)
{
    page->template_left = sizeof page_template;
    for (size_t i = 0; i < PAGE_TEMPLATE_PIECES; i++) {
        size_t begin = page_template_pieces[i], end = page_template_pieces[i + 1];
        fwrite(page_template + begin, 1, end - begin, page->file);
        page->template_left -= end - begin;
        if (i + 1 < PAGE_TEMPLATE_PIECES && !put_part(page, page_template_parts[i]))
            return false;
    }
    return true;
}

static bool fill_file(struct page *page)
{
    page->choices = calloc((size_t)page->sweep->point_count + 1, sizeof *page->choices);
    bool filled = page->choices != NULL;
    if (filled) {
        page->choice_count =
            page_choose(page->sweep, page->recommendations, page->recommendation_count,
                        page->choices, &page->prominent_count);
        filled = put_page(page);
    }
    if (!filled)
        text_say("the page could not be made: out of memory");
    free(page->choices);
    return filled;
}

bool page_write(const struct sweep *sweep, const struct sweep_recommendation *recommendations,
                uint32_t count, const char *path)
{
    struct page page = {
        .sweep = sweep, .recommendations = recommendations, .recommendation_count = count};
    struct output_file *output = output_file_begin(path);
    if (!output)
        return false;
    page.file = output_file_stream(output);
    return output_file_end(output, fill_file(&page));
}
