/** Every invariant that can be looked at, after every call. */
#ifndef TESTS_CORE_SOUND_H
#define TESTS_CORE_SOUND_H

#include "core/fixture.h"

/**
 * The manager's own invariants; every slot of every heap is free, retiring or held by one counted
 * tile; the statistics say how much memory is taken.
 */
void check_sound(const struct fixture *f, int line);

#define CHECK_SOUND(f) check_sound(f, __LINE__)

/** A call that must succeed, and what must hold after it. */
#define SOUND(f, call)                                                                             \
    do {                                                                                           \
        CHECK_OK(call);                                                                            \
        CHECK_SOUND(f);                                                                            \
    } while (0)

/** A call that must be refused and change nothing that can be seen of these textures. */
#define REFUSED(f, id_count, ids, call, expected)                                                  \
    do {                                                                                           \
        uint64_t digest_before_ = fixture_digest(f, id_count, ids);                                \
        CHECK_RESULT(call, expected);                                                              \
        CHECK_SOUND(f);                                                                            \
        assert_true(fixture_digest(f, id_count, ids) == digest_before_);                           \
    } while (0)

/** As those of the fixture, with a check after the call. */
void sound_feed(struct fixture *f, SluiceTextureId id, uint8_t level, uint64_t time,
                uint64_t timeout);
void sound_feed_region(struct fixture *f, SluiceTextureId id, uint32_t region, uint8_t level,
                       uint64_t time, uint64_t timeout);

/** All tiles that the last list held, one answer per tile, with a check after each. */
void sound_answer_mapped(struct fixture *f);

/** Lists and maps until nothing more is handed out: one answer per run of equal textures. */
void sound_load(struct fixture *f);

#endif /* TESTS_CORE_SOUND_H */
