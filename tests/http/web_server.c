#define _XOPEN_SOURCE 700

#include "http/web_server.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

struct web_server web_server;

static FILE *output;
static int input; /* the server ends when it is closed */
static pid_t process;

static void run_server(const int *in, const int *out)
{
    char script[512];
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(script, sizeof script, "%s/tests/http/faulty_server.py", root ? root : ".");
    dup2(in[0], 0);
    dup2(out[1], 1);
    close(in[1]);
    close(out[0]);
    execlp("python3", "python3", script, (char *)NULL);
    _exit(127);
}

int web_server_start(void **state)
{
    int in[2], out[2];
    (void)state;
    if (pipe(in) != 0 || pipe(out) != 0)
        return -1;
    process = fork();
    if (process == 0)
        run_server(in, out);
    close(in[0]);
    close(out[1]);
    input = in[1];
    output = fdopen(out[0], "r");
    int found = fscanf(output, "%u %u %u %255s", &web_server.ports[0], &web_server.ports[1],
                       &web_server.ports[2], web_server.certificate);
    return found == 4 ? 0 : -1;
}

int web_server_stop(void **state)
{
    (void)state;
    close(input);
    fclose(output);
    return waitpid(process, NULL, 0) == process ? 0 : -1;
}
