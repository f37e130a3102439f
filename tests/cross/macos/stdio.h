/* files of C */
#ifndef MACOS_STUB_STDIO_H
#define MACOS_STUB_STDIO_H

#include <stdarg.h>
#include <sys/types.h>

typedef struct macos_stub_file FILE;
extern FILE *__stderrp;
#define stderr __stderrp
#define SEEK_SET 0
#define SEEK_END 2

int fclose(FILE *file);
FILE *fopen(const char *path, const char *mode);
int fprintf(FILE *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
size_t fread(void *bytes, size_t size, size_t count, FILE *file);
int fseek(FILE *file, long offset, int from);
long ftell(FILE *file);
int fputs(const char *text, FILE *file);
int rename(const char *from, const char *to);
int snprintf(char *text, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
int sscanf(const char *text, const char *format, ...) __attribute__((format(scanf, 2, 3)));
int vsnprintf(char *text, size_t size, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));

#endif /* MACOS_STUB_STDIO_H */
