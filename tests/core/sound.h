/** Checks all visible invariants after every call. */
#ifndef TESTS_CORE_SOUND_H
#define TESTS_CORE_SOUND_H

#include "core/fixture.h"

/**
 * Checks the manager's own invariants, and that every slot is free, retiring or held by one counted
 * tile. The statistics must match the allocated memory.
 */
void check_sound(const struct fixture *f, int line);

#define CHECK_SOUND(f) check_sound(f, __LINE__)

/** Makes a call that must succeed, and checks all invariants. */
#define SOUND(f, call)                                                                             \
    do {                                                                                           \
        CHECK_OK(call);                                                                            \
        CHECK_SOUND(f);                                                                            \
    } while (0)

/** Makes a call that must be refused, and checks that no visible state of these textures
 * changed. */
#define REFUSED(f, id_count, ids, call, expected)                                                  \
    do {                                                                                           \
        uint64_t digest_before_ = fixture_digest(f, id_count, ids);                                \
        CHECK_RESULT(call, expected);                                                              \
        CHECK_SOUND(f);                                                                            \
        assert_true(fixture_digest(f, id_count, ids) == digest_before_);                           \
    } while (0)

/** The fixture's functions of these names, with a check after each call. */
void sound_feed(struct fixture *f, SluiceTextureId id, uint8_t level, uint64_t time,
                uint64_t timeout);
void sound_feed_region(struct fixture *f, SluiceTextureId id, uint32_t region, uint8_t level,
                       uint64_t time, uint64_t timeout);

/** Reports all tiles of the last list as mapped, one answer per tile, with a check after each. */
void sound_answer_mapped(struct fixture *f);

/** Lists and maps tiles until none is handed out, one answer per run of equal textures. */
void sound_load(struct fixture *f);

#endif /* TESTS_CORE_SOUND_H */
