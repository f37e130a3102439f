#define _GNU_SOURCE /* prctl and POSIX */
#include "child.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "../common/clock.h"
#include "../common/input.h"
#include "memory.h"

#define MOST_OUTPUT (64 << 20) ///< limit in bytes, for each of standard output and standard error
#define LONGEST_REASON 400
#define NOT_STARTED 127

static volatile sig_atomic_t interrupted;

static void take_signal(int number)
{
    (void)number;
    interrupted = 1;
}

void child_watch_interruptions(void)
{
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {0};
    action.sa_handler = take_signal;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        sigaction(numbers[i], &action, NULL);
}

bool child_is_interrupted(void)
{
    return interrupted != 0;
}

/* Runs in the new process. */
static void execute(const struct child_info *info, const int files[3])
{
    for (int i = 0; i < 3; i++)
        dup2(files[i], i);
    if (info->environment)
        putenv(info->environment);
    execv(info->arguments[0], info->arguments);
    dprintf(2, "%s: %s\n", info->arguments[0], strerror(errno));
    _exit(NOT_STARTED);
}

static void become(const struct child_info *info, const int files[3])
{
    setpgid(0, 0);
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    execute(info, files);
}

/* Forks twice: the process between ends at once, so the program is no child of this process. */
static void detach(const struct child_info *info, const int files[3])
{
    setsid();
    const pid_t pid = fork();
    if (pid == 0)
        execute(info, files);
    _exit(pid > 0 ? 0 : NOT_STARTED);
}

/* Returns -1 and sets errno if the files cannot be opened or no process can be created. */
static pid_t begin(const struct child_info *info,
                   void (*run)(const struct child_info *info, const int files[3]))
{
    const int write_flags = O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC;
    int files[3] = {open("/dev/null", O_RDONLY | O_CLOEXEC), open(info->out, write_flags, 0666),
                    open(info->error, write_flags, 0666)};
    const bool opened = files[0] >= 0 && files[1] >= 0 && files[2] >= 0;
    const pid_t pid = opened ? fork() : -1;
    if (pid == 0)
        run(info, files);
    int error = errno;
    for (int i = 0; i < 3; i++)
        if (files[i] >= 0)
            close(files[i]);
    errno = error;
    return pid;
}

bool child_begin(const struct child_info *info, struct child *child)
{
    *child = (struct child){.info = *info, .started = clock_seconds()};
    const pid_t pid = begin(info, become);
    if (pid <= 0)
        return false;
    setpgid(pid, pid); /* parent and child both call it; the first call counts */
    child->pid = pid;
    return true;
}

bool child_begin_detached(const struct child_info *info)
{
    int status = 0;
    const pid_t pid = begin(info, detach);
    if (pid <= 0)
        return false;
    while (waitpid(pid, &status, 0) < 0)
        if (errno != EINTR)
            return false;
    errno = EAGAIN; /* the second fork failed */
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

static bool is_too_large(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && info.st_size > MOST_OUTPUT;
}

enum child_state child_poll(struct child *child, int *status)
{
    pid_t ended = waitpid(child->pid, status, WNOHANG);
    if (ended == 0 && !child->killed) {
        if (child->info.limit > 0.0 && clock_seconds() - child->started > child->info.limit)
            child->killed = "it took longer than the time limit";
        else if (is_too_large(child->info.out) || is_too_large(child->info.error))
            child->killed = "it printed more than 64 MiB";
        if (child->killed)
            kill(-child->pid, SIGKILL);
    }
    if (ended == 0 || (ended < 0 && errno == EINTR))
        return CHILD_RUNS;
    kill(-child->pid, SIGKILL); /* its remaining children */
    child->pid = 0;
    return ended > 0 && WIFEXITED(*status) && WEXITSTATUS(*status) == 0 && !child->killed
               ? CHILD_DONE
               : CHILD_FAILED;
}

void child_kill(struct child *child)
{
    int status;
    if (child->pid <= 0)
        return;
    kill(-child->pid, SIGKILL);
    while (waitpid(child->pid, &status, 0) < 0 && errno == EINTR)
        continue;
    child->pid = 0;
}

enum child_state child_wait(struct child *child, int *status)
{
    enum child_state state;
    while ((state = child_poll(child, status)) == CHILD_RUNS) {
        if (child_is_interrupted()) {
            child_kill(child);
            return CHILD_FAILED;
        }
        clock_sleep_until(clock_seconds() + 0.005);
    }
    return state;
}

/* Copies the last non-empty line of a file's end; "" if there is none. */
static void last_line(const char *path, char *line, size_t size)
{
    char text[2 * LONGEST_REASON + 1];
    FILE *file = input_open(path);
    line[0] = '\0';
    if (!file)
        return;
    if (fseek(file, -2 * LONGEST_REASON, SEEK_END) != 0)
        rewind(file);
    size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    while (length > 0 && strchr(" \t\r\n", text[length - 1]))
        length--;
    size_t start = length;
    while (start > 0 && text[start - 1] != '\n' && text[start - 1] != '\r' && text[start - 1])
        start--;
    snprintf(line, size, "%.*s", (int)(length - start), text + start);
}

char *child_reason(const struct child *child, int status)
{
    char line[LONGEST_REASON], what[64];
    if (child->killed)
        return memory_copy_text(child->killed);
    if (WIFSIGNALED(status))
        snprintf(what, sizeof what, "signal %d (%s)", WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    else
        snprintf(what, sizeof what, "exit status %d", WEXITSTATUS(status));
    last_line(child->info.error, line, sizeof line);
    return memory_text("%s%s%s", what, line[0] ? ": " : "", line);
}
