#define _POSIX_C_SOURCE 200809L
#include "support/captured_stderr.h"

#include "support/test.h"

#include <stdio.h>
#include <unistd.h>

static char text[1 << 16];
static int kept;
static FILE *caught;

void captured_stderr_begin(void)
{
    fflush(stderr);
    kept = dup(STDERR_FILENO);
    caught = tmpfile();
    assert_non_null(caught);
    assert_true(dup2(fileno(caught), STDERR_FILENO) >= 0);
}

const char *captured_stderr_end(void)
{
    fflush(stderr);
    rewind(caught);
    text[fread(text, 1, sizeof text - 1, caught)] = '\0';
    dup2(kept, STDERR_FILENO);
    close(kept);
    fclose(caught);
    return text;
}
