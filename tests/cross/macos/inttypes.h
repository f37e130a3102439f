/* formats of integers: 64 bits are long long on macOS */
#ifndef MACOS_STUB_INTTYPES_H
#define MACOS_STUB_INTTYPES_H

#include <stdint.h>

#define PRId32 "d"
#define PRIi32 "i"
#define PRIu32 "u"
#define PRIx32 "x"
#define PRIX32 "X"
#define PRId64 "lld"
#define PRIi64 "lli"
#define PRIu64 "llu"
#define PRIx64 "llx"
#define PRIX64 "llX"
#define PRIu8 "hhu"
#define PRIu16 "hu"
#define SCNu64 "llu"
#define SCNx64 "llx"

#endif /* MACOS_STUB_INTTYPES_H */
