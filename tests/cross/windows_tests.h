/** Included before every test for Windows: what tests use of POSIX and MinGW-w64 lacks. */
#ifndef TESTS_CROSS_WINDOWS_TESTS_H
#define TESTS_CROSS_WINDOWS_TESTS_H

#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <stdio.h>
#include <stdlib.h>

/* The last six letters become a number that no other folder has. */
static inline char *test_make_folder(char *pattern)
{
    return _mktemp(pattern) && _mkdir(pattern) == 0 ? pattern : NULL;
}

/* MinGW-w64's own mkstemp deletes the file when it is closed. */
static inline int test_make_file(char *pattern)
{
    return _mktemp(pattern) ? _open(pattern, _O_CREAT | _O_EXCL | _O_RDWR | _O_BINARY, 0600) : -1;
}

/* The place of the next _write moves, which no test minds. */
static inline long long test_write_at(int file, const void *bytes, size_t size, long long offset)
{
    return _lseeki64(file, offset, SEEK_SET) == offset ? _write(file, bytes, (unsigned)size) : -1;
}

#define pwrite test_write_at
#define mkdtemp test_make_folder
#define mkstemp test_make_file

#endif /* TESTS_CROSS_WINDOWS_TESTS_H */
