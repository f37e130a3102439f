#include "demand/fake_memory.h"

#include "support/test.h"

void fake_memory_init(struct fake_memory *memory, uint32_t place_count, uint32_t chunk_size)
{
    assert_true(place_count <= FAKE_PLACES);
    *memory = (struct fake_memory){.place_count = place_count, .chunk_size = chunk_size};
    for (uint32_t i = 0; i < place_count; i++)
        memory->owners[i] = SLC_NO_PAGE;
}

static bool is_empty(const struct fake_memory *m, uint32_t chunk)
{
    for (uint32_t i = chunk * m->chunk_size; i < (chunk + 1) * m->chunk_size; i++)
        if (i < m->place_count && m->taken[i])
            return false;
    return true;
}

static uint32_t take(void *user, uint32_t kind)
{
    struct fake_memory *m = user;
    uint32_t best = SLC_NO_PLACE;
    for (uint32_t i = 0; i < m->place_count; i++) {
        uint32_t chunk = i / m->chunk_size;
        if (!m->taken[i] && (m->kinds[chunk] == kind || is_empty(m, chunk)) &&
            (best == SLC_NO_PLACE || m->given[i] < m->given[best]))
            best = i;
    }
    if (best == SLC_NO_PLACE)
        return best;
    m->kinds[best / m->chunk_size] = kind;
    m->taken[best] = true;
    m->owners[best] = SLC_NO_PAGE;
    m->taken_count++;
    return best;
}

static void give(void *user, uint32_t place, uint32_t page)
{
    struct fake_memory *m = user;
    assert_true(place < m->place_count && m->taken[place]);
    m->taken[place] = false;
    m->owners[place] = page;
    m->given[place] = ++m->clock;
    m->taken_count--;
}

static bool retake(void *user, uint32_t place, uint32_t page)
{
    struct fake_memory *m = user;
    assert_true(place < m->place_count && page != SLC_NO_PAGE);
    if (m->taken[place] || m->owners[place] != page)
        return false;
    m->taken[place] = true;
    m->owners[place] = SLC_NO_PAGE;
    m->taken_count++;
    return true;
}

struct slc_page_memory fake_page_memory(struct fake_memory *memory)
{
    return (struct slc_page_memory){memory, take, give, retake};
}
