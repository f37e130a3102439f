/* assert, as ISO C has it */
#ifndef MACOS_STUB_ASSERT_H
#define MACOS_STUB_ASSERT_H

#ifdef NDEBUG
#define assert(condition) ((void)0)
#else
_Noreturn void __assert_rtn(const char *function, const char *file, int line, const char *text);
#define assert(condition)                                                                          \
    ((condition) ? (void)0 : __assert_rtn(__func__, __FILE__, __LINE__, #condition))
#endif
#define static_assert _Static_assert

#endif /* MACOS_STUB_ASSERT_H */
